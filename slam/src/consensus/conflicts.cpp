#include "conflicts.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

namespace isotherm::slam::detail {
namespace {

constexpr std::size_t kLookedAt = 8;  // nearest accepted loops
constexpr std::size_t kNamed = 3;

using Chains = std::pair<Index, Index>;

template <class Pose>
Chains chains_of(const ReducedGraph<Pose>& graph, const ForwardLoop<Pose>& loop) {
  return {graph.odometry.chain(loop.from), graph.odometry.chain(loop.to)};
}

// Accepted loops of one pair of chains in the order of their first ends.
struct ByFirstEnd {
  std::vector<std::pair<Index, Index>> from_and_loop;

  // The loops nearest to `loop`, by steps of odometry between their ends. The
  // search goes outwards from its first end until that alone is too far.
  template <class Pose>
  std::vector<Index> nearest(const std::vector<ForwardLoop<Pose>>& loops, Index loop) const {
    const auto& centre = loops[loop];
    std::vector<std::pair<Index, Index>> found;  // distance, loop; sorted
    const auto offer = [&](std::pair<Index, Index> entry) {
      const Index first = std::abs(entry.first - centre.from);
      if (found.size() == kLookedAt && first > found.back().first) return false;
      const std::pair<Index, Index> candidate = {
          first + std::abs(loops[entry.second].to - centre.to), entry.second};
      found.insert(std::upper_bound(found.begin(), found.end(), candidate), candidate);
      if (found.size() > kLookedAt) found.pop_back();
      return true;
    };
    const auto middle = std::lower_bound(from_and_loop.begin(), from_and_loop.end(),
                                         std::pair<Index, Index>{centre.from, 0});
    for (auto at = middle; at != from_and_loop.end() && offer(*at);) ++at;
    for (auto at = middle; at != from_and_loop.begin() && offer(*std::prev(at));) --at;
    std::vector<Index> result;
    for (const auto& entry : found) result.push_back(entry.second);
    return result;
  }
};

}  // namespace

template <class Pose>
std::vector<std::vector<Index>> name_conflicts(const ReducedGraph<Pose>& graph,
                                               const MapVolume<Pose>& map,
                                               const CovarianceScale& scale, double gate,
                                               const std::vector<bool>& accepted,
                                               const std::vector<bool>& refuted) {
  const auto loops = forward_loops(graph, scale);
  std::map<Chains, ByFirstEnd> groups;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (!accepted[k]) continue;
    auto& group = groups[chains_of(graph, loops[k])];
    group.from_and_loop.emplace_back(loops[k].from, static_cast<Index>(k));
  }
  for (auto& entry : groups) std::ranges::sort(entry.second.from_and_loop);

  std::vector<std::vector<Index>> conflicts(loops.size());
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto group = groups.find(chains_of(graph, loops[k]));
    if (!refuted[k] || group == groups.end()) continue;
    const auto near = group->second.nearest(loops, static_cast<Index>(k));
    auto& named = conflicts[k];
    std::ranges::copy_if(near, std::back_inserter(named), [&](Index other) {
      return compare(graph, scale, loops[other], loops[k], map).chi2 > gate;
    });
    if (named.empty()) named = near;
    named.resize(std::min(named.size(), kNamed));
  }
  return conflicts;
}

template std::vector<std::vector<Index>> name_conflicts(const ReducedGraph<Pose2>&,
                                                        const MapVolume<Pose2>&,
                                                        const CovarianceScale&, double,
                                                        const std::vector<bool>&,
                                                        const std::vector<bool>&);
template std::vector<std::vector<Index>> name_conflicts(const ReducedGraph<Pose3>&,
                                                        const MapVolume<Pose3>&,
                                                        const CovarianceScale&, double,
                                                        const std::vector<bool>&,
                                                        const std::vector<bool>&);

}  // namespace isotherm::slam::detail
