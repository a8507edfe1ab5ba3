#include "graph/simple_graph.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace isotherm::spectral::detail {

SimpleGraph merge_parallel_edges(const WeightedGraph& graph) {
  const auto edges = graph.edges();
  SimpleGraph simple;
  simple.merged.assign(edges.size(), SimpleGraph::kNone);
  std::vector<Index> order;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    if (edges[e].from != edges[e].to) order.push_back(e);
  }
  const auto ends = [&](Index e) { return std::minmax(edges[e].from, edges[e].to); };
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::tuple(ends(a), a) < std::tuple(ends(b), b); });
  std::vector<WeightedEdge> merged;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto& edge = edges[order[k]];
    if (k > 0 && ends(order[k]) == ends(order[k - 1])) {
      auto& weight = merged.back().weight;
      weight = std::min(weight + edge.weight, std::numeric_limits<double>::max());
    } else {
      merged.push_back(edge);
    }
    simple.merged[order[k]] = static_cast<Index>(merged.size()) - 1;
  }
  simple.graph = WeightedGraph(graph.vertex_count(), std::move(merged));
  return simple;
}

}  // namespace isotherm::spectral::detail
