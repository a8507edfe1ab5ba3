#include "graph/bridges.hpp"

#include <algorithm>

namespace isotherm::spectral::detail {
namespace {

/// A vertex on the path of the depth-first search.
struct Visit {
  Index vertex = 0;
  Index entered_by = -1;  // edge
  std::size_t next = 0;   // position among the neighbours
};

}  // namespace

std::vector<bool> find_bridges(const WeightedGraph& graph) {
  constexpr Index kUnseen = -1;
  std::vector<bool> bridge(graph.edges().size(), false);
  std::vector<Index> order(graph.vertex_count(), kUnseen);
  std::vector<Index> lowest(graph.vertex_count(), 0);  // order reachable by one back edge
  Index seen = 0;
  std::vector<Visit> path;
  const auto enter = [&](Index vertex, Index edge) {
    order[vertex] = lowest[vertex] = seen++;
    path.push_back({vertex, edge, 0});
  };
  for (Index root = 0; root < graph.vertex_count(); ++root) {
    if (order[root] != kUnseen) continue;
    enter(root, -1);
    while (!path.empty()) {
      const auto [vertex, entered_by, next] = path.back();
      const auto neighbours = graph.neighbours(vertex);
      if (next < neighbours.size()) {
        ++path.back().next;
        const auto [other, edge] = neighbours[next];
        if (edge == entered_by) continue;
        if (order[other] == kUnseen) {
          enter(other, edge);
        } else {
          lowest[vertex] = std::min(lowest[vertex], order[other]);
        }
        continue;
      }
      path.pop_back();
      if (path.empty()) continue;
      const Index parent = path.back().vertex;
      lowest[parent] = std::min(lowest[parent], lowest[vertex]);
      bridge[entered_by] = lowest[vertex] > order[parent];
    }
  }
  return bridge;
}

}  // namespace isotherm::spectral::detail
