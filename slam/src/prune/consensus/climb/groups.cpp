#include "prune/consensus/climb/groups.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "graph/find_root.hpp"

namespace isotherm::slam::detail {
namespace {

// Groups accepted at once are all true with even odds at least.
constexpr double kMostExpectedFalse = 0.5;

template <class Pose>
std::vector<std::vector<Index>> runs_of(const Runs<Pose>& runs, const std::vector<bool>& open,
                                        const std::vector<double>& run_density,
                                        const std::function<double(Index)>& alternative) {
  std::vector<Index> parent(open.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t k = 0; k < open.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    const Index before = runs.before(loop);
    if (before == Runs<Pose>::kNone || !open[k] || !open[before]) continue;
    if (run_density[k] > alternative(loop)) {
      parent[find_root(parent, loop)] = find_root(parent, before);
    }
  }
  std::vector<std::vector<Index>> groups(open.size());
  for (std::size_t k = 0; k < open.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (open[k]) groups[find_root(parent, loop)].push_back(loop);
  }
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

}  // namespace

template <class Pose>
std::vector<Group> gaining_groups(const Runs<Pose>& runs, const std::vector<bool>& open,
                                  const std::vector<Standing>& standings,
                                  const std::vector<double>& run_density,
                                  const std::function<double(Index)>& alternative) {
  std::vector<Group> gaining;
  for (auto& loops : runs_of(runs, open, run_density, alternative)) {
    const Index seed =
        *std::ranges::max_element(loops, {}, [&](Index k) { return standings[k].evidence; });
    double gain = standings[seed].log_odds - standings[seed].evidence;
    for (const Index k : loops) {
      double evidence = standings[k].evidence;
      const Index before = runs.before(k);
      if (k != seed && before != Runs<Pose>::kNone && std::ranges::binary_search(loops, before)) {
        evidence = std::max(evidence, run_density[k] - alternative(k));
      }
      gain += evidence;
    }
    if (gain > 0.0) gaining.push_back({std::move(loops), gain, standings[seed].connected});
  }
  return gaining;
}

std::vector<Index> most_certain(std::vector<Group> groups) {
  const bool any_connected =
      std::ranges::any_of(groups, [](const Group& group) { return group.connected; });
  if (any_connected) std::erase_if(groups, [](const Group& group) { return !group.connected; });
  std::ranges::stable_sort(groups, std::greater{}, &Group::gain);
  std::vector<Index> loops;
  double expected_false = 0.0;
  for (const auto& [members, gain, connected] : groups) {
    expected_false += 1.0 / (1.0 + std::exp(gain));
    if (!loops.empty() && (!connected || expected_false > kMostExpectedFalse)) break;
    loops.insert(loops.end(), members.begin(), members.end());
  }
  return loops;
}

template std::vector<Group> gaining_groups(const Runs<Pose2>&, const std::vector<bool>&,
                                           const std::vector<Standing>&, const std::vector<double>&,
                                           const std::function<double(Index)>&);
template std::vector<Group> gaining_groups(const Runs<Pose3>&, const std::vector<bool>&,
                                           const std::vector<Standing>&, const std::vector<double>&,
                                           const std::function<double(Index)>&);

}  // namespace isotherm::slam::detail
