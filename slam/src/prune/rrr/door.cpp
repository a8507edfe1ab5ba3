#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam::detail {

template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const RrrOptions& options, const RunContext& run) {
  PruneResult result;
  result.method = RrrOptions::method();
  result.verdicts = rrr(graph, roles, options, run);
  return result;
}

template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const RrrOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const RrrOptions&,
                              const RunContext&);

}  // namespace isotherm::slam::detail
