#include <string>

#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam::detail {

template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const HeatPruneOptions& options, const RunContext& run) {
  auto found = heat_prune(graph, roles, options, run);
  PruneResult result;
  result.method = HeatPruneOptions::method();
  result.verdicts = std::move(found.verdicts);
  result.rounds = std::move(found.rounds);
  if (found.unconverged > 0) {
    result.warnings.push_back(std::to_string(found.unconverged) +
                              " heat distances are known less exactly than asked for");
  }
  return result;
}

template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const HeatPruneOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const HeatPruneOptions&,
                              const RunContext&);

}  // namespace isotherm::slam::detail
