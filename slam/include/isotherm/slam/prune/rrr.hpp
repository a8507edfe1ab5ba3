#pragma once

#include <concepts>
#include <string_view>
#include <type_traits>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/optimize/initialize.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::slam {

struct PruneResult;  // prune.hpp

/// Realizing, reversing, recovering: Y. Latif, C. Cadena, J. Neira, "Robust loop
/// closing over time for pose graph SLAM", IJRR 32(14), 2013.
struct RrrOptions {
  static std::string_view method() { return "rrr"; }
  static std::string_view title() { return "Realizing, reversing, recovering"; }

  /// Loops are in one cluster if both their ends are at most this many poses
  /// apart, through neighbours if need be; > 0. The authors' program has 50.
  int rrr_cluster_gap = 50;
  /// Probability of the chi-squared tests; in (0, 1). The paper's 0.95.
  double rrr_confidence = 0.95;
  /// Gauss-Newton steps an optimisation may take. The authors' default of 4 is too
  /// few in space; > 0.
  int rrr_iterations = 20;
  /// Let loops part from their cluster: those that fit the start are tried first, and
  /// at the end those of rejected clusters one by one. False: clusters stand or fall
  /// as a whole, as in the paper.
  bool rrr_split = true;
  /// Where every optimisation starts. automatic: switchable, with the quantile of a
  /// loop for the width. The paper's is odometry.
  Initialization initialization = Initialization::automatic;

  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, RrrOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("rrr_cluster_gap", options.rrr_cluster_gap,
        "poses between loops of one cluster, at both ends", closed(1, 1e6));
  visit("rrr_confidence", options.rrr_confidence, "probability of the chi-squared tests",
        open(0, 1));
  visit("rrr_iterations", options.rrr_iterations, "steps an optimisation may take", closed(1, 1e6));
  visit("rrr_split", options.rrr_split, "let loops part from their cluster");
  visit("initialization", options.initialization, "where every optimisation starts");
}

/// Clusters of candidates (positions in roles.candidates) whose two ends are close,
/// each ascending, in the order of their first loop.
template <class Pose>
std::vector<std::vector<Index>> cluster_loops(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                              int gap);

/// Verdicts by consistency of clusters of loops.
///
/// Within each cluster the loops that chi-squared rejects after optimising odometry
/// with the cluster alone go ("intra-cluster": odometry is contracted to the ends
/// of the loops, exact to first order), or the whole cluster ("cluster") if the sum
/// over the graph exceeds the quantile for all its constraints. Then clusters are
/// accepted together ("inter-cluster"); while one of them, or the graph, fails its
/// test, the most inconsistent cluster is put back, to be tried again as the accepted
/// set grows. (The paper sums over all clusters at once, which lets a small false one
/// pass among many good ones.)
///
/// A round tries the clusters with a loop that fits the current estimate; where
/// drift lets none fit odometry, the first round tries all. With `rrr_split` this is
/// done three times: for the loops of each cluster that fit the start, for whole
/// clusters, and for the loops that are left, one by one. The paper has the second
/// only, where one false loop takes its cluster with it.
/// The score is chi-squared where the loop was decided, the threshold its quantile;
/// a loop rejected with its cluster gets the cluster's chi-squared and quantile.
/// @throws InvalidArgument, Cancelled
template <class Pose>
spectral::EdgeVerdicts rrr(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                           const RrrOptions& options = {}, const RunContext& run = {});

namespace detail {

/// The door of the method's room, through which prune() comes.
template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const RrrOptions& options, const RunContext& run);

}  // namespace detail

}  // namespace isotherm::slam
