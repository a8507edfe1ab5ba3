#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "isotherm/base/options.hpp"
#include "isotherm/base/progress.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/network/range_network.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

/// Positions of the nodes of a sensor network from the distances between them,
/// some of which are false or too long.
namespace isotherm::network {

enum class LocalizeMethod {
  robust,         ///< false and biased ranges are found and left out
  least_squares,  ///< all ranges count, from the same start; the baseline
};

constexpr std::array<EnumName<LocalizeMethod>, 2> enum_names(LocalizeMethod) {
  return {{{LocalizeMethod::robust, "robust"}, {LocalizeMethod::least_squares, "least-squares"}}};
}

/// What is known about a node.
enum class NodeStatus {
  anchor,         ///< its position was given
  localised,      ///< its position and covariance are in the result
  mirrored,       ///< rigid, but a mirror image of it or its surroundings fits as well
  not_rigid,      ///< it can move without changing any trusted range, or by more than a typical one
                  ///< within the noise
  not_connected,  ///< no trusted ranges lead to the anchors (or to the largest part)
  not_placed,     ///< nothing of the above, but no start was found for it
};

constexpr std::array<EnumName<NodeStatus>, 6> enum_names(NodeStatus) {
  return {{{NodeStatus::anchor, "anchor"},
           {NodeStatus::localised, "localised"},
           {NodeStatus::mirrored, "mirrored"},
           {NodeStatus::not_rigid, "not-rigid"},
           {NodeStatus::not_connected, "not-connected"},
           {NodeStatus::not_placed, "not-placed"}}};
}

struct LocalizeOptions {
  LocalizeMethod method = LocalizeMethod::robust;
  /// Probability with which a correct range may be called false, until it is judged by all others;
  /// in (0, 1). The gate of what fits a map is the chi-squared quantile of the rest.
  double significance = 1e-3;
  /// A node, or a part of the network, counts as localised if its second-best place is
  /// less likely than its best one by this factor; in (0, 1). The share of false ranges plays a
  /// part: the more there are, the less does a single range prove.
  double mirror_chance = 1e-3;
  /// Leave out, at the start, ranges that the heat kernel finds suspicious. They are
  /// judged again once there are positions.
  bool heat_pruning = true;
  /// That test leaves out a range that is less likely than this to be a true one; in
  /// (0, 1). Well below one half, since the later tests know more.
  double heat_chance = 0.1;
  /// Ranges between the same two nodes count as one, their median: what makes one of them
  /// wrong (multipath, antenna delays) they have in common. Otherwise each counts.
  bool merge_repeats = true;
  /// Scale the standard deviations of the ranges by a common factor found from their
  /// residuals. Ranges without one always get theirs this way.
  bool estimate_noise = true;
  /// Networks of no more nodes are one neighbourhood, of which the heat kernel says nothing; >= 5.
  int patch_size = 32;
  int max_iterations = 100;  ///< of a refinement, >= 1
  int threads = 0;           ///< 0: all cores; results do not depend on it
  ProgressCallback progress = {};

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, LocalizeOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("method", options.method, "leave false ranges out, or fit them all");
  visit("significance", options.significance, "probability of calling a correct range false",
        open(0, 1));
  visit("mirror_chance", options.mirror_chance, "likelihood of a node's second-best place",
        open(0, 1));
  visit("heat_pruning", options.heat_pruning,
        "let the heat kernel choose the ranges to start from");
  visit("heat_chance", options.heat_chance, "start without ranges less likely true than this",
        open(0, 1));
  visit("merge_repeats", options.merge_repeats, "take the median of ranges between two nodes");
  visit("estimate_noise", options.estimate_noise, "scale standard deviations by the residuals");
  visit("patch_size", options.patch_size, "networks of no more nodes are not judged by heat",
        closed(5, 1000));
  visit("max_iterations", options.max_iterations, "most iterations of a refinement",
        closed(1, 1e6));
}

enum class LocalizeStatus {
  converged,
  not_converged,  ///< the last refinement was still moving
  no_start,       ///< no part of the network could be placed
};

constexpr std::array<EnumName<LocalizeStatus>, 3> enum_names(LocalizeStatus) {
  return {{{LocalizeStatus::converged, "converged"},
           {LocalizeStatus::not_converged, "not-converged"},
           {LocalizeStatus::no_start, "no-start"}}};
}

struct LocalizeResult {
  Eigen::MatrixXd positions;                 ///< dimension x nodes; NaN where there is none
  std::vector<Eigen::MatrixXd> covariances;  ///< d x d a localised node, empty for others
  std::vector<NodeStatus> nodes;
  /// One a range, in order; ends are positions among the nodes. The score is the log of the odds
  /// of being wrong, given all others; with least squares the leave-one-out chi-squared.
  spectral::EdgeVerdicts verdicts;
  LocalizeStatus status = LocalizeStatus::converged;
  bool anchored = false;      ///< false: positions are known up to an isometry
  double noise_factor = 1.0;  ///< by which given standard deviations were multiplied
  double sigma = 0.0;         ///< found for ranges that came without, 0 if there are none
  double chi2 = 0.0;          ///< of the kept ranges between nodes with a position
  std::int64_t dof = 0;       ///< kept ranges less unknowns
  int iterations = 0;         ///< of the refinements
  int rounds = 0;             ///< of deciding on the ranges
  double seconds = 0.0;

  std::int64_t count(NodeStatus status) const;
};

/// Positions, covariances, and a verdict on every range.
///
/// Heat-kernel pruning, maps by shortest paths that springs unfold, moves of nodes and mirrored
/// parts as long as the map becomes likelier, then the maximum of the joint density of all ranges,
/// each of which may be correct, too long or anything: docs/concepts/localization.md. Where most
/// nodes near each other have a range, places beside nodes without one count as less likely.
/// Landmarks of the network with a position are the anchors; they do not move. Without anchors the
/// largest part is placed in a frame of its own, and covariances are those of the shape (minimal
/// trace). With anchors in too small a number, or on one line (plane), nodes whose mirror image
/// fits as well get that status and no position. Memory O(nodes + ranges) apart from the fill of a
/// sparse factorisation.
/// @throws InvalidArgument for options out of range, or a network with a range that
///   is negative, not finite, from a node to itself or to one that does not exist;
///   NumericalError, Cancelled.
LocalizeResult localize(const RangeNetwork& network, const LocalizeOptions& options = {});

}  // namespace isotherm::network
