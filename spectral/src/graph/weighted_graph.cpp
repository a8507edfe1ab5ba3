#include "isotherm/spectral/graph/weighted_graph.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral {
namespace {

void check_edge(const WeightedEdge& edge, std::size_t id, Index vertex_count) {
  const std::string name = "edges[" + std::to_string(id) + "]";
  if (edge.from < 0 || edge.from >= vertex_count || edge.to < 0 || edge.to >= vertex_count) {
    throw InvalidArgument(name, "end outside [0, " + std::to_string(vertex_count) + ")");
  }
  if (!std::isfinite(edge.weight) || edge.weight <= 0.0) {
    throw InvalidArgument(name, "weight must be finite and positive");
  }
}

}  // namespace

WeightedGraph::WeightedGraph(Index vertex_count, std::vector<WeightedEdge> edges)
    : edges_(std::move(edges)) {
  if (vertex_count < 0) throw InvalidArgument("vertex_count", "must not be negative");
  offsets_.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (std::size_t id = 0; id < edges_.size(); ++id) {
    const auto& edge = edges_[id];
    check_edge(edge, id, vertex_count);
    ++offsets_[edge.from + 1];
    if (edge.to != edge.from) ++offsets_[edge.to + 1];
  }
  for (std::size_t v = 1; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];

  neighbours_.resize(offsets_.back());
  std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t id = 0; id < edges_.size(); ++id) {
    const auto& edge = edges_[id];
    neighbours_[next[edge.from]++] = {edge.to, static_cast<Index>(id)};
    if (edge.to != edge.from) neighbours_[next[edge.to]++] = {edge.from, static_cast<Index>(id)};
  }
}

std::span<const Neighbour> WeightedGraph::neighbours(Index vertex) const {
  const auto first = offsets_[vertex];
  const auto last = offsets_[vertex + 1];
  return std::span(neighbours_).subspan(first, last - first);
}

ConnectedComponents connected_components(const WeightedGraph& graph) {
  constexpr Index kUnseen = -1;
  ConnectedComponents components;
  components.label.assign(graph.vertex_count(), kUnseen);
  std::vector<Index> stack;
  for (Index root = 0; root < graph.vertex_count(); ++root) {
    if (components.label[root] != kUnseen) continue;
    components.label[root] = components.count;
    stack.push_back(root);
    while (!stack.empty()) {
      const Index vertex = stack.back();
      stack.pop_back();
      for (const auto& neighbour : graph.neighbours(vertex)) {
        if (components.label[neighbour.vertex] != kUnseen) continue;
        components.label[neighbour.vertex] = components.count;
        stack.push_back(neighbour.vertex);
      }
    }
    ++components.count;
  }
  return components;
}

Eigen::VectorXd weighted_degrees(const WeightedGraph& graph) {
  Eigen::VectorXd degrees = Eigen::VectorXd::Zero(graph.vertex_count());
  for (const auto& edge : graph.edges()) {
    if (edge.from == edge.to) continue;
    degrees[edge.from] += edge.weight;
    degrees[edge.to] += edge.weight;
  }
  return degrees;
}

WeightedGraph filter_edges(const WeightedGraph& graph, const std::vector<bool>& keep) {
  if (keep.size() != graph.edges().size()) {
    throw InvalidArgument("keep", "must have one entry per edge");
  }
  std::vector<WeightedEdge> kept;
  for (std::size_t id = 0; id < keep.size(); ++id) {
    if (keep[id]) kept.push_back(graph.edges()[id]);
  }
  return WeightedGraph(graph.vertex_count(), std::move(kept));
}

std::vector<VertexPair> edge_pairs(const WeightedGraph& graph) {
  std::vector<VertexPair> pairs;
  pairs.reserve(graph.edges().size());
  for (const auto& edge : graph.edges()) pairs.push_back({edge.from, edge.to});
  return pairs;
}

}  // namespace isotherm::spectral
