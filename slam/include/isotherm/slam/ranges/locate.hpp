#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/network/localize/localize.hpp"
#include "isotherm/slam/graph/range_graph.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

/// Robots that move among beacons: one estimate of odometry and ranges.
namespace isotherm::slam {

/// Where the estimate starts from.
enum class RangeStart {
  automatic,  ///< odometry and ranges alone
  file,       ///< the positions that the file gives, of all nodes
};

constexpr std::array<EnumName<RangeStart>, 2> enum_names(RangeStart) {
  return {{{RangeStart::automatic, "automatic"}, {RangeStart::file, "file"}}};
}

/// Whether something is part of the model.
enum class ModelChoice {
  automatic,  ///< if that makes the measurements likelier
  yes,
  no,
};

constexpr std::array<EnumName<ModelChoice>, 3> enum_names(ModelChoice) {
  return {
      {{ModelChoice::automatic, "automatic"}, {ModelChoice::yes, "yes"}, {ModelChoice::no, "no"}}};
}

struct LocateOptions {
  RangeStart start = RangeStart::automatic;
  ModelChoice bias = ModelChoice::automatic;  ///< ranges may be too long, as without line of sight
  ModelChoice calibrate = ModelChoice::automatic;  ///< ranges share a constant offset and a stretch
  /// A range is pruned if it is correct with a lower probability than this, and kept if it is so
  /// with a higher one than the rest of 1; in (0, 0.5].
  double doubt = 0.1;
  int max_steps = 200;  ///< of an estimate, >= 1

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, LocateOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("start", options.start, "with odometry: start from it, or from the file's positions");
  visit("bias", options.bias, "with odometry: whether ranges may be too long");
  visit("calibrate", options.calibrate,
        "with odometry: learn an offset and a stretch of all ranges");
  visit("doubt", options.doubt, "with odometry: prune ranges less likely correct than this",
        left_open(0, 0.5));
  visit("max_steps", options.max_steps, "with odometry: most steps of an estimate", closed(1, 1e6));
}

/// What was found of the ranges in common.
struct RangeErrors {
  double scale = 1.0;       ///< on the stated standard deviations
  double odometry = 1.0;    ///< on the stated covariances of odometry
  double too_long = 0.0;    ///< share of ranges that are
  double excess = 0.0;      ///< by how much on average, metres
  double anything = 0.0;    ///< share of ranges that say nothing
  bool calibrated = false;  ///< whether the next two were learned
  double offset = 0.0;      ///< metres: ranges are offset + stretch * distance
  double stretch = 1.0;
};

template <class Pose>
struct LocateResult {
  std::vector<Pose> poses;                   ///< one a node; of a point, the rotation means nothing
  std::vector<network::NodeStatus> nodes;    ///< one a node
  std::vector<Eigen::MatrixXd> covariances;  ///< of positions, d x d; empty for nodes without one
  /// One a range. The score is that of the error against the spread of correct ranges, left out;
  /// the stage says what the range is taken for.
  spectral::EdgeVerdicts verdicts;
  network::LocalizeStatus status = network::LocalizeStatus::converged;
  bool anchored = false;  ///< false: positions are in the frame of the first pose
  RangeErrors errors;
  double cost = 0.0;      ///< -log density of all measurements, up to a constant
  double evidence = 0.0;  ///< log evidence, up to the same
  int iterations = 0;
  double seconds = 0.0;

  std::int64_t count(network::NodeStatus status) const;
};

/// Poses of all robots, places of all beacons and a verdict on every range, by one objective: the
/// density of steps and ranges, where a range is correct, too long or anything, and the shares of
/// these, the scales of all errors, and, if that is likelier, an offset and a stretch of ranges are
/// learned. docs/concepts/ranges.md.
///
/// The start needs no truth: odometry is chained, and windows of time that grow take in ranges;
/// a beacon, or another robot, joins the map as soon as its ranges leave one place for it, and
/// where they leave several to the end, these are tried. `anchors` are points that are known
/// where the graph says they are.
/// Memory O(nodes + ranges) apart from the fill of a sparse factorisation.
/// @throws InvalidArgument for options out of range, anchors that are no points with a position, a
///   start from the file where it lacks a position, or indices and numbers that are out of range;
///   NumericalError, Cancelled.
template <class Pose>
LocateResult<Pose> locate(const RangeGraph<Pose>& graph, const std::vector<Index>& anchors,
                          const LocateOptions& options = {}, const RunContext& run = {});

extern template LocateResult<Pose2> locate(const RangeGraph<Pose2>&, const std::vector<Index>&,
                                           const LocateOptions&, const RunContext&);
extern template LocateResult<Pose3> locate(const RangeGraph<Pose3>&, const std::vector<Index>&,
                                           const LocateOptions&, const RunContext&);

}  // namespace isotherm::slam
