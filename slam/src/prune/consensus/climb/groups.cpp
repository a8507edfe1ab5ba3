#include "prune/consensus/climb/groups.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

#include "graph/find_root.hpp"
#include "prune/consensus/constants.hpp"
#include "prune/consensus/log_odds.hpp"

namespace isotherm::slam::detail {
namespace {

// Parents of a forest for find_root().
std::vector<Index> each_by_itself(std::size_t count) {
  std::vector<Index> parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  return parent;
}

template <class Pose>
std::vector<std::vector<Index>> runs_of(const Assessment<Pose>& assessment,
                                        const Explanation<Pose>& now,
                                        const std::vector<bool>& among) {
  const auto& runs = assessment.objective().runs();
  std::vector<Index> parent = each_by_itself(among.size());
  for (std::size_t k = 0; k < among.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    const Index before = runs.before(loop);
    if (before == Runs<Pose>::kNone || !among[k] || !among[before]) continue;
    if (now.accepted[k] || assessment.log_led(loop) > 0.0) {
      parent[find_root(parent, loop)] = find_root(parent, before);
    }
  }
  std::vector<std::vector<Index>> groups(among.size());
  for (std::size_t k = 0; k < among.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (among[k]) groups[find_root(parent, loop)].push_back(loop);
  }
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

// Each part by itself, by its number.
std::vector<Index> numbered_parts(const std::vector<Group>& groups) {
  Index count = 0;
  for (const Group& group : groups) {
    count = std::max({count, group.parts.first + 1, group.parts.second + 1});
  }
  return each_by_itself(static_cast<std::size_t>(count));
}

}  // namespace

template <class Pose>
std::vector<Group> groups_of(const Assessment<Pose>& assessment, const Explanation<Pose>& now,
                             const std::vector<bool>& among) {
  const auto& runs = assessment.objective().runs();
  const auto& standings = now.standings;
  std::vector<Group> groups;
  for (auto& loops : runs_of(assessment, now, among)) {
    const Index seed =
        *std::ranges::max_element(loops, {}, [&](Index k) { return standings[k].evidence; });
    double gain = assessment.log_prior_odds(now, loops) - assessment.log_false_run(loops);
    for (const Index k : loops) {
      const bool led = k != seed && std::ranges::binary_search(loops, runs.before(k));
      const double own = standings[k].evidence;
      gain += led ? std::max(own, assessment.log_led(k)) : own;
    }
    groups.push_back({std::move(loops), gain, standings[seed].parts});
  }
  return groups;
}

Group most_certain(std::vector<Group> groups, std::size_t accepted) {
  std::ranges::stable_sort(groups, std::greater{}, &Group::gain);
  Group all;
  std::vector<Index> part = numbered_parts(groups);
  double expected_false = 0.0;
  for (const auto& [members, gain, parts] : groups) {
    expected_false += probability_of(-gain);
    const bool many =
        all.loops.size() + members.size() > kBatchGrowth * std::max<std::size_t>(accepted, 1);
    if (!all.loops.empty() && (many || expected_false > kMostExpectedFalse)) break;
    if (parts.first != parts.second) {
      const Index first = find_root(part, parts.first);
      const Index second = find_root(part, parts.second);
      if (first == second) continue;
      part[first] = second;
    }
    all.loops.insert(all.loops.end(), members.begin(), members.end());
    all.gain += gain;
  }
  return all;
}

template std::vector<Group> groups_of(const Assessment<Pose2>&, const Explanation<Pose2>&,
                                      const std::vector<bool>&);
template std::vector<Group> groups_of(const Assessment<Pose3>&, const Explanation<Pose3>&,
                                      const std::vector<bool>&);

}  // namespace isotherm::slam::detail
