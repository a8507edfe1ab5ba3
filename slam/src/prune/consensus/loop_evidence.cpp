#include "isotherm/slam/prune/loop_evidence.hpp"

#include <algorithm>
#include <limits>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/usable_odometry.hpp"
#include "prune/consensus/climb/climb.hpp"
#include "prune/consensus/climb/starts.hpp"
#include "prune/set_aside.hpp"

namespace isotherm::slam {
namespace {

// One flag a candidate.
std::vector<bool> flags_of(const std::vector<Index>& edges, const EdgeRoles& roles) {
  std::vector<bool> flags(roles.candidates.size(), false);
  for (const Index edge : edges) {
    const auto at = std::ranges::lower_bound(roles.candidates, edge);
    if (at == roles.candidates.end() || *at != edge) {
      throw InvalidArgument("edges", "edge " + std::to_string(edge) + " is not a candidate");
    }
    flags[static_cast<std::size_t>(at - roles.candidates.begin())] = true;
  }
  return flags;
}

template <class Pose>
double highest_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                        const std::vector<bool>& accepted, const ConsensusOptions& options,
                        const RunContext& run) {
  const detail::Objective<Pose> objective(graph, roles, options.window, options.calibrate);
  detail::Climb<Pose> climb(objective, options, run.progress);
  double highest = -std::numeric_limits<double>::infinity();
  for (const auto& start : detail::kStarts) {
    try {
      highest = std::max(highest, climb.settled_on(accepted, start).evidence);
    } catch (const NumericalError&) {
      continue;  // scales at which the normal equations break down explain nothing
    }
    if (!options.calibrate) break;
  }
  return highest;
}

}  // namespace

template <class Pose>
double loop_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const std::vector<Index>& edges, const ConsensusOptions& options,
                     const RunContext& run) {
  options.validate();
  const std::vector<bool> asked = flags_of(edges, roles);
  EdgeRoles judged = roles;
  const SetAside set_aside(graph, judged);
  if (judged.candidates.empty()) return 0.0;
  std::vector<bool> accepted;
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (std::ranges::binary_search(judged.candidates, roles.candidates[k])) {
      accepted.push_back(asked[k]);
    }
  }
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
