#include "graph/series_reduction.hpp"

#include <array>

namespace isotherm::spectral::detail {
namespace {

/// Follows chains from edge to edge.
class ChainWalker {
 public:
  ChainWalker(const WeightedGraph& graph, const std::vector<bool>& left_out)
      : graph_(graph), left_out_(left_out), degrees_(graph.vertex_count(), 0) {
    for (Index e = 0; e < graph.edge_count(); ++e) {
      if (!is_used(e)) continue;
      ++degrees_[graph.edge(e).from];
      ++degrees_[graph.edge(e).to];
    }
  }

  bool is_used(Index edge) const {
    return !left_out_[edge] && graph_.edge(edge).from != graph_.edge(edge).to;
  }

  /// Calls take(edge) for each edge after `edge` on the way through `vertex`, and
  /// returns where the chain ends; kNone if it comes back to `edge`.
  template <class Take>
  Index follow(const Index edge, Index vertex, Take take) const {
    Index current = edge;
    while (degrees_[vertex] == 2) {
      current = other_edge(vertex, current);
      if (current == edge) return SeriesReduction::kNone;
      take(current);
      vertex = graph_.edge(current).from + graph_.edge(current).to - vertex;
    }
    return vertex;
  }

 private:
  Index other_edge(Index vertex, Index edge) const {
    for (const auto& neighbour : graph_.neighbours(vertex)) {
      if (neighbour.edge != edge && is_used(neighbour.edge)) return neighbour.edge;
    }
    return edge;
  }

  const WeightedGraph& graph_;
  const std::vector<bool>& left_out_;
  std::vector<Index> degrees_;
};

}  // namespace

SeriesReduction reduce_series(const WeightedGraph& graph, const std::vector<bool>& left_out) {
  SeriesReduction reduction;
  reduction.chains.assign(graph.edges().size(), SeriesReduction::kNone);
  const ChainWalker walker(graph, left_out);
  std::vector<WeightedEdge> edges;
  std::vector<bool> seen(graph.edges().size(), false);
  std::vector<Index> chain;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    if (seen[e] || !walker.is_used(e)) continue;
    chain.assign(1, e);
    seen[e] = true;
    const auto take = [&](Index edge) {
      if (!seen[edge]) chain.push_back(edge);
      seen[edge] = true;
    };
    const std::array ends = {walker.follow(e, graph.edge(e).from, take),
                             walker.follow(e, graph.edge(e).to, take)};
    if (ends[0] == ends[1]) continue;
    double resistance = 0.0;
    for (const Index edge : chain) {
      reduction.chains[edge] = static_cast<Index>(edges.size());
      resistance += 1.0 / graph.edge(edge).weight / static_cast<double>(chain.size());
    }
    reduction.lengths.push_back(static_cast<double>(chain.size()));
    edges.push_back({ends[0], ends[1], 1.0 / resistance});
  }
  reduction.graph = WeightedGraph(graph.vertex_count(), std::move(edges));
  return reduction;
}

}  // namespace isotherm::spectral::detail
