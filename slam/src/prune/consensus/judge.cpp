#include "prune/consensus/judge.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "graph/candidate_verdicts.hpp"
#include "prune/consensus/climb/climb.hpp"
#include "prune/consensus/search/report.hpp"
#include "prune/consensus/search/search.hpp"

namespace isotherm::slam {

template <class Pose>
bool detail::has_information(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  const auto says_something = [&graph](Index k) {
    return !graph.constraints[k].information.isZero(0.0);
  };
  return std::ranges::any_of(roles.odometry, says_something) &&
         std::ranges::any_of(roles.candidates, says_something);
}

namespace {

template <class Pose>
std::vector<OdometrySlip> slips_of(const PoseGraph<Pose>& graph, const detail::Slips& slips) {
  std::vector<OdometrySlip> result;
  for (std::size_t v = 0; v < slips.size(); ++v) {
    if (slips[v] == 0) continue;
    result.push_back({graph.ids[v], graph.ids[v + 1], std::sqrt(detail::slip_factor(slips[v]))});
  }
  return result;
}

}  // namespace

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
  result.odometry_slips = slips_of(graph, found.front().shapes.slips);
  return result;
}

template ConsensusResult detail::judge_by_evidence(const PoseGraph<Pose2>&, const EdgeRoles&,
                                                   const ConsensusOptions&, const RunContext&);
template ConsensusResult detail::judge_by_evidence(const PoseGraph<Pose3>&, const EdgeRoles&,
                                                   const ConsensusOptions&, const RunContext&);

template bool detail::has_information(const PoseGraph<Pose2>&, const EdgeRoles&);
template bool detail::has_information(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam
