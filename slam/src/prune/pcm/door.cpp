#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam::detail {

template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const PcmOptions& options, const RunContext& run) {
  auto found = pcm(graph, roles, options, run);
  PruneResult result;
  result.method = PcmOptions::method();
  result.verdicts = std::move(found.verdicts);
  if (!found.proven) {
    result.warnings.push_back("the consistent set is the largest found, not proven the largest");
  }
  return result;
}

template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const PcmOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const PcmOptions&,
                              const RunContext&);

}  // namespace isotherm::slam::detail
