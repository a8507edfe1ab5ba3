#pragma once

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
  OptimizeOptions optimize;
};

/// What each stage gave back.
template <class Pose>
struct PipelineResult {
  EdgeRoles roles;
  PruneResult decisions;
  PoseGraph<Pose> pruned;  ///< with the optimised poses
  OptimizeResult<Pose> optimized;
};

/// Prunes and optimises. @throws what its stages throw
template <class Pose>
PipelineResult<Pose> prune_and_optimize(const PoseGraph<Pose>& graph,
                                        const PipelineOptions& options = {});

}  // namespace isotherm::slam
