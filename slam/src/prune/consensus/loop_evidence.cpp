#include "isotherm/slam/prune/loop_evidence.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/usable_odometry.hpp"
#include "prune/consensus/climb/climb.hpp"
#include "prune/consensus/search/starts.hpp"
#include "prune/set_aside.hpp"

namespace isotherm::slam {
namespace {

void require_candidates(const std::vector<Index>& edges, const EdgeRoles& roles) {
  for (const Index edge : edges) {
    if (!std::ranges::binary_search(roles.candidates, edge)) {
      throw InvalidArgument("edges", "edge " + std::to_string(edge) + " is not a candidate");
    }
  }
}

// One flag a candidate.
std::vector<bool> flags_of(std::vector<Index> edges, const EdgeRoles& roles) {
  std::ranges::sort(edges);
  std::vector<bool> flags;
  for (const Index candidate : roles.candidates) {
    flags.push_back(std::ranges::binary_search(edges, candidate));
  }
  return flags;
}

template <class Pose>
double highest_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                        const std::vector<bool>& accepted, const ConsensusOptions& options,
                        const RunContext& run) {
  const detail::Objective<Pose> objective(graph, roles, options.window, options.calibrate);
  detail::Climb<Pose> climb(objective, options, run);
  std::vector<detail::Explanation<Pose>> found;
  settle_on(climb, accepted, found);
  return found.empty() ? -std::numeric_limits<double>::infinity() : best_of(found).evidence;
}

}  // namespace

template <class Pose>
double loop_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const std::vector<Index>& edges, const ConsensusOptions& options,
                     const RunContext& run) {
  options.validate();
  require_candidates(edges, roles);
  EdgeRoles judged = roles;
  const detail::SetAside set_aside(graph, judged);
  if (judged.candidates.empty()) return 0.0;
  const std::vector<bool> accepted = flags_of(edges, judged);
  const auto unusable = unusable_information(graph, judged);
  return unusable.empty() ? highest_evidence(graph, judged, accepted, options, run)
                          : highest_evidence(with_usable_information(graph, judged, unusable),
                                             judged, accepted, options, run);
}

template double loop_evidence(const PoseGraph<Pose2>&, const EdgeRoles&, const std::vector<Index>&,
                              const ConsensusOptions&, const RunContext&);
template double loop_evidence(const PoseGraph<Pose3>&, const EdgeRoles&, const std::vector<Index>&,
                              const ConsensusOptions&, const RunContext&);

}  // namespace isotherm::slam
