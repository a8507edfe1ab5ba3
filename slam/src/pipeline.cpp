#include "isotherm/slam/pipeline.hpp"

namespace isotherm::slam {

template <class Pose>
PipelineResult<Pose> prune_and_optimize(const PoseGraph<Pose>& graph,
                                        const PipelineOptions& options) {
  PipelineResult<Pose> result;
  result.roles = edge_roles(graph);
  result.decisions = prune(graph, result.roles, options.prune);
  result.pruned = apply_verdicts(graph, result.decisions.verdicts, options.keep_ambiguous);
  result.optimized = optimize(result.pruned, options.optimize);
  result.pruned.poses = result.optimized.poses;
  return result;
}

template PipelineResult<Pose2> prune_and_optimize(const PoseGraph<Pose2>&, const PipelineOptions&);
template PipelineResult<Pose3> prune_and_optimize(const PoseGraph<Pose3>&, const PipelineOptions&);

}  // namespace isotherm::slam
