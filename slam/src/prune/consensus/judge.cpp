#include "prune/consensus/judge.hpp"

#include <algorithm>

#include "graph/candidate_verdicts.hpp"
#include "prune/consensus/climb/climb.hpp"
#include "prune/consensus/climb/report.hpp"
#include "prune/consensus/climb/search.hpp"

namespace isotherm::slam {

template <class Pose>
bool detail::has_information(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  const auto says_something = [&graph](Index k) {
    return !graph.constraints[k].information.isZero(0.0);
  };
  return std::ranges::any_of(roles.odometry, says_something) &&
         std::ranges::any_of(roles.candidates, says_something);
}

template <class Pose>
ConsensusResult detail::judge_by_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                          const ConsensusOptions& options, const RunContext& run) {
  ConsensusResult result;
  result.verdicts = detail::candidate_verdicts(graph, roles);
  if (roles.candidates.empty()) return result;
  const detail::Objective<Pose> objective(graph, roles, options.window, options.calibrate);
  detail::Climb<Pose> climb(objective, options, run);
  const auto found = detail::search(climb);
  result.moves = climb.moves();
  result.settled = climb.settled();
  detail::report(found, options.significance, result);
  return result;
}

template ConsensusResult detail::judge_by_evidence(const PoseGraph<Pose2>&, const EdgeRoles&,
                                                   const ConsensusOptions&, const RunContext&);
template ConsensusResult detail::judge_by_evidence(const PoseGraph<Pose3>&, const EdgeRoles&,
                                                   const ConsensusOptions&, const RunContext&);

template bool detail::has_information(const PoseGraph<Pose2>&, const EdgeRoles&);
template bool detail::has_information(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam
