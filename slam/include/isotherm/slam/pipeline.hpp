#pragma once

#include <optional>

#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/any_pose_graph.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/optimize/optimize.hpp"
#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam {

/// How a poisoned pose graph becomes a map:
///
///     graph -edge_roles-> odometry and candidates -prune-> verdicts
///           -apply_verdicts-> pruned graph -optimize-> poses
///
/// Every arrow is a free function of its own; this only calls them in order.
/// Before it stand read_pose_graph and write_g2o (io/), after it evaluate_loops.
struct PipelineOptions {
  PruneOptions prune;
  bool keep_ambiguous = false;  ///< leave candidates that are not proven either way
  /// Nothing: the last arrow is left out, and poses stay as they are.
  std::optional<OptimizeOptions> optimize = OptimizeOptions{};
};

/// What each stage gave back; Graph is a PoseGraph<Pose> or AnyPoseGraph.
template <class Graph>
struct PipelineResult {
  EdgeRoles roles;
  PruneResult decisions;
  Graph pruned;  ///< with the optimised poses
  std::optional<OptimizeSummary> optimized;
};

/// Prunes and optimises. @throws what its stages throw
template <class Pose>
PipelineResult<PoseGraph<Pose>> prune_and_optimize(const PoseGraph<Pose>& graph,
                                                   const PipelineOptions& options = {},
                                                   const RunContext& run = {});
PipelineResult<AnyPoseGraph> prune_and_optimize(const AnyPoseGraph& graph,
                                                const PipelineOptions& options = {},
                                                const RunContext& run = {});

/// The same with given roles in place of edge_roles().
template <class Pose>
PipelineResult<PoseGraph<Pose>> prune_and_optimize(const PoseGraph<Pose>& graph,
                                                   const EdgeRoles& roles,
                                                   const PipelineOptions& options,
                                                   const RunContext& run = {});

}  // namespace isotherm::slam
