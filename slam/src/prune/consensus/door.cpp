#include <algorithm>
#include <string>

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
  result.consensus = consensus(graph, roles, options, run);
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
