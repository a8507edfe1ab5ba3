#include <string>
#include <utility>

#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam {

PruneResult prune_result(HeatPruneResult found) {
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

namespace detail {

template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const HeatPruneOptions& options, const RunContext& run) {
  return prune_result(heat_prune(graph, roles, options, run));
}

template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const HeatPruneOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const HeatPruneOptions&,
                              const RunContext&);

}  // namespace detail

}  // namespace isotherm::slam
