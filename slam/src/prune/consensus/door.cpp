#include <algorithm>
#include <string>

#include "isotherm/slam/graph/information.hpp"
#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam::detail {
namespace {

// Whether covariances can be had of odometry and of loops: some matrix of each says
// something.
template <class Pose>
bool has_information(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  const auto says_something = [&graph](Index k) {
    return !graph.constraints[k].information.isZero(0.0);
  };
  return std::ranges::any_of(roles.odometry, says_something) &&
         std::ranges::any_of(roles.candidates, says_something);
}

// What needs no information matrices, in place of consensus.
template <class Pose>
PruneResult prune_by_structure(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                               const RunContext& run) {
  HeatPruneOptions structure;
  structure.induction.weights = LoopWeights::uniform;
  PruneResult result = prune_by(graph, roles, structure, run);
  result.warnings.push_back(
      "information matrices say nothing; heat distances with uniform weights decided instead");
  return result;
}

// Odometry as consensus can chain it, and a warning for what had to be changed.
template <class Pose>
PoseGraph<Pose> with_usable_odometry(const PoseGraph<Pose>& graph,
                                     const std::vector<Index>& unusable,
                                     std::vector<std::string>& warnings) {
  PoseGraph<Pose> repaired = graph;
  for (const Index k : unusable) {
    auto& information = repaired.constraints[k].information;
    information = usable_information<Pose::kDof>(information);
  }
  const auto& first = graph.constraints[unusable.front()];
  std::string warning = "odometry edge " + std::to_string(unusable.front()) + ", from vertex " +
                        std::to_string(graph.ids[first.from]) + " to " +
                        std::to_string(graph.ids[first.to]);
  if (unusable.size() > 1) warning += ", and " + std::to_string(unusable.size() - 1) + " more";
  warnings.push_back(warning +
                     ": information matrix too near to a singular one; made less extreme");
  return repaired;
}

}  // namespace

template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const ConsensusOptions& options, const RunContext& run) {
  options.validate();
  if (!roles.candidates.empty() && !has_information(graph, roles)) {
    return prune_by_structure(graph, roles, run);
  }
  PruneResult result;
  result.method = ConsensusOptions::method();
  const auto unusable = unusable_odometry(graph, roles);
  if (unusable.empty()) {
    result.consensus = consensus(graph, roles, options, run);
  } else {
    const auto repaired = with_usable_odometry(graph, unusable, result.warnings);
    result.consensus = consensus(repaired, roles, options, run);
  }
  result.verdicts = std::move(result.consensus.verdicts);
  if (!result.consensus.settled) {
    result.warnings.push_back("consensus stopped after " + std::to_string(options.max_rounds) +
                              " rounds with loops still in question");
  }
  return result;
}

template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const ConsensusOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const ConsensusOptions&,
                              const RunContext&);

}  // namespace isotherm::slam::detail
