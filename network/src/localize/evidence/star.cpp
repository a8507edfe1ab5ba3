#include "localize/evidence/star.hpp"

#include <algorithm>
#include <cmath>

namespace isotherm::network::detail {
namespace {

template <class Usable>
SmallNetwork star_of(const RangeProblem& problem, const Placement& placement, Index node,
                     const Usable& usable) {
  std::vector<Index> members;
  SmallNetwork network;
  for (const auto& [vertex, edge] : problem.pair_graph.neighbours(node)) {
    if (!placement.placed[vertex] || !usable(edge)) continue;
    const auto& pair = problem.pairs[edge];
    network.ranges.push_back({static_cast<int>(members.size()), 0, pair.distance, pair.sigma});
    members.push_back(vertex);
  }
  for (auto& range : network.ranges) range.to = static_cast<int>(members.size());
  members.push_back(node);
  network.positions = placement.positions(Eigen::all, members);
  network.fixed = static_cast<int>(members.size()) - 1;
  return network;
}

}  // namespace

SmallNetwork star(const RangeProblem& problem, const Placement& placement, Index node) {
  return star_of(problem, placement, node, [](Index) { return true; });
}

SmallNetwork star(const RangeProblem& problem, const Placement& placement, Index node,
                  const std::vector<bool>& usable) {
  return star_of(problem, placement, node, [&](Index edge) { return usable[edge]; });
}

int agreeing(const SmallNetwork& network, double gate) {
  return static_cast<int>(std::count_if(
      network.ranges.begin(), network.ranges.end(),
      [&](const SmallRange& range) { return std::pow(deviation(network, range), 2) <= gate; }));
}

}  // namespace isotherm::network::detail
