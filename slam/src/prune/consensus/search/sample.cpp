#include "prune/consensus/search/sample.hpp"

#include <algorithm>
#include <numeric>

#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {

template <class Pose>
std::vector<Index> sample(const ReducedGraph<Pose>& graph, Index window, std::size_t every) {
  const auto closed_at = [&graph](Index loop) {
    return graph.vertex[std::max(graph.loops[loop].a, graph.loops[loop].b)];
  };
  if (every < 2) return {};
  std::vector<Index> order(graph.loops.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, closed_at);
  std::vector<Index> chosen;
  std::size_t stretch = 0;
  Index began = order.empty() ? 0 : closed_at(order.front());
  for (const Index loop : order) {
    if (closed_at(loop) > began + window) {
      began = closed_at(loop);
      ++stretch;
    }
    if (stretch % every == every / 2) chosen.push_back(loop);
  }
  if (chosen.size() < kLeastSample) return {};
  std::ranges::sort(chosen);
  return chosen;
}

template std::vector<Index> sample(const ReducedGraph<Pose2>&, Index, std::size_t);
template std::vector<Index> sample(const ReducedGraph<Pose3>&, Index, std::size_t);

}  // namespace isotherm::slam::detail
