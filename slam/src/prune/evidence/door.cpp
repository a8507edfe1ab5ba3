#include <string>

#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam::detail {

template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const EvidenceOptions& options, const RunContext& run) {
  PruneResult result;
  result.method = EvidenceOptions::method();
  result.evidence = judge_by_evidence(graph, roles, options, run);
  result.verdicts = std::move(result.evidence.verdicts);
  if (!result.evidence.settled) {
    result.warnings.push_back("a climb stopped after " + std::to_string(options.max_rounds) +
                              " moves with loops still in question");
  }
  return result;
}

template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const EvidenceOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const EvidenceOptions&,
                              const RunContext&);

}  // namespace isotherm::slam::detail
