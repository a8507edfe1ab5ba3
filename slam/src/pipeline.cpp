#include "isotherm/slam/pipeline.hpp"

#include <utility>

namespace isotherm::slam {
namespace {

// The roles of the constraints that stayed, at their new positions.
EdgeRoles roles_of_kept(const EdgeRoles& roles, const PruneResult& decisions, bool keep_ambiguous) {
  EdgeRoles kept;
  Index next = 0;
  auto odometry = roles.odometry.begin();
  for (const auto& verdict : decisions.verdicts) {
    for (; odometry != roles.odometry.end() && *odometry < verdict.edge; ++odometry) {
      kept.odometry.push_back(next++);
    }
    if (stays(verdict, keep_ambiguous)) kept.candidates.push_back(next++);
  }
  for (; odometry != roles.odometry.end(); ++odometry) kept.odometry.push_back(next++);
  return kept;
}

}  // namespace

template <class Pose>
PipelineResult<PoseGraph<Pose>> prune_and_optimize(const PoseGraph<Pose>& graph,
                                                   const EdgeRoles& roles,
                                                   const PipelineOptions& options,
                                                   const RunContext& run) {
  PipelineResult<PoseGraph<Pose>> result;
  result.roles = roles;
  result.decisions = prune(graph, roles, options.prune, run);
  result.pruned = apply_verdicts(graph, result.decisions.verdicts, options.keep_ambiguous);
  if (options.optimize) {
    const auto kept = roles_of_kept(roles, result.decisions, options.keep_ambiguous);
    auto optimized = optimize(result.pruned, kept, *options.optimize, run);
    result.pruned.poses = std::move(optimized.poses);
    result.optimized = std::move(optimized);
  }
  return result;
}

template <class Pose>
PipelineResult<PoseGraph<Pose>> prune_and_optimize(const PoseGraph<Pose>& graph,
                                                   const PipelineOptions& options,
                                                   const RunContext& run) {
  return prune_and_optimize(graph, edge_roles(graph), options, run);
}

PipelineResult<AnyPoseGraph> prune_and_optimize(const AnyPoseGraph& any,
                                                const PipelineOptions& options,
                                                const RunContext& run) {
  return std::visit(
      [&](const auto& graph) {
        auto result = prune_and_optimize(graph, options, run);
        return PipelineResult<AnyPoseGraph>{std::move(result.roles), std::move(result.decisions),
                                            std::move(result.pruned), std::move(result.optimized)};
      },
      any);
}

template PipelineResult<PoseGraph<Pose2>> prune_and_optimize(const PoseGraph<Pose2>&,
                                                             const EdgeRoles&,
                                                             const PipelineOptions&,
                                                             const RunContext&);
template PipelineResult<PoseGraph<Pose3>> prune_and_optimize(const PoseGraph<Pose3>&,
                                                             const EdgeRoles&,
                                                             const PipelineOptions&,
                                                             const RunContext&);
template PipelineResult<PoseGraph<Pose2>> prune_and_optimize(const PoseGraph<Pose2>&,
                                                             const PipelineOptions&,
                                                             const RunContext&);
template PipelineResult<PoseGraph<Pose3>> prune_and_optimize(const PoseGraph<Pose3>&,
                                                             const PipelineOptions&,
                                                             const RunContext&);

}  // namespace isotherm::slam
