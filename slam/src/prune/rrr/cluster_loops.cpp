#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "graph/find_root.hpp"
#include "isotherm/slam/prune/rrr.hpp"

namespace isotherm::slam {

template <class Pose>
std::vector<std::vector<Index>> cluster_loops(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                              int gap) {
  const auto count = static_cast<Index>(roles.candidates.size());
  struct Ends {
    Index low;
    Index high;
  };
  std::vector<Ends> ends;
  for (const Index k : roles.candidates) {
    const auto& constraint = graph.constraints[k];
    ends.push_back(
        {std::min(constraint.from, constraint.to), std::max(constraint.from, constraint.to)});
  }
  std::vector<Index> by_low(static_cast<std::size_t>(count));
  std::iota(by_low.begin(), by_low.end(), 0);
  std::sort(by_low.begin(), by_low.end(), [&](Index a, Index b) {
    return std::pair(ends[a].low, a) < std::pair(ends[b].low, b);
  });
  std::vector<Index> parent(static_cast<std::size_t>(count));
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t a = 0; a < by_low.size(); ++a) {
    for (std::size_t b = a + 1; b < by_low.size(); ++b) {
      const Ends& first = ends[by_low[a]];
      const Ends& second = ends[by_low[b]];
      if (second.low - first.low > gap) break;
      if (std::abs(second.high - first.high) > gap) continue;
      const Index x = detail::find_root(parent, by_low[a]);
      const Index y = detail::find_root(parent, by_low[b]);
      parent[std::max(x, y)] = std::min(x, y);
    }
  }
  std::vector<std::vector<Index>> clusters;
  std::vector<Index> cluster_of(static_cast<std::size_t>(count), -1);
  for (Index c = 0; c < count; ++c) {
    Index& cluster = cluster_of[detail::find_root(parent, c)];
    if (cluster < 0) {
      cluster = static_cast<Index>(clusters.size());
      clusters.emplace_back();
    }
    clusters[cluster].push_back(c);
  }
  return clusters;
}

template std::vector<std::vector<Index>> cluster_loops(const PoseGraph<Pose2>&, const EdgeRoles&,
                                                       int);
template std::vector<std::vector<Index>> cluster_loops(const PoseGraph<Pose3>&, const EdgeRoles&,
                                                       int);

}  // namespace isotherm::slam
