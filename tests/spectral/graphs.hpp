#pragma once

#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "isotherm/base/random.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

/// Graphs the spectral tests are run on.
namespace isotherm_test {

using isotherm::Random;
using isotherm::spectral::Index;
using isotherm::spectral::WeightedEdge;
using isotherm::spectral::WeightedGraph;

/// A mark at every edge.
inline std::vector<bool> all_edges(const WeightedGraph& graph) {
  return std::vector<bool>(graph.edges().size(), true);
}

/// The same worth for every edge.
inline std::vector<double> equal_worth(const WeightedGraph& graph, double value = 1.0) {
  return std::vector<double>(graph.edges().size(), value);
}

inline WeightedGraph path_graph(Index n, double weight = 1.0) {
  std::vector<WeightedEdge> edges;
  for (Index v = 0; v + 1 < n; ++v) edges.push_back({v, v + 1, weight});
  return {n, std::move(edges)};
}

inline WeightedGraph ring_graph(Index n) {
  std::vector<WeightedEdge> edges;
  for (Index v = 0; v < n; ++v) edges.push_back({v, (v + 1) % n, 1.0});
  return {n, std::move(edges)};
}

/// Vertex 0 in the middle.
inline WeightedGraph star_graph(Index n) {
  std::vector<WeightedEdge> edges;
  for (Index v = 1; v < n; ++v) edges.push_back({0, v, 1.0});
  return {n, std::move(edges)};
}

inline WeightedGraph complete_graph(Index n) {
  std::vector<WeightedEdge> edges;
  for (Index i = 0; i < n; ++i) {
    for (Index j = i + 1; j < n; ++j) edges.push_back({i, j, 1.0});
  }
  return {n, std::move(edges)};
}

/// Vertex (x, y) is y * width + x.
inline WeightedGraph grid_graph(Index width, Index height) {
  std::vector<WeightedEdge> edges;
  for (Index y = 0; y < height; ++y) {
    for (Index x = 0; x < width; ++x) {
      const Index v = y * width + x;
      if (x + 1 < width) edges.push_back({v, v + 1, 1.0});
      if (y + 1 < height) edges.push_back({v, v + width, 1.0});
    }
  }
  return {width * height, std::move(edges)};
}

inline Index random_vertex(Random& random, Index n) {
  return static_cast<Index>(random.index(static_cast<std::uint64_t>(n)));
}

/// A path with `loops` extra edges between random vertices, like a pose graph.
inline WeightedGraph loopy_path(Index n, Index loops, Random& random) {
  const auto path = path_graph(n);
  std::vector<WeightedEdge> edges(path.edges().begin(), path.edges().end());
  for (Index k = 0; k < loops; ++k) {
    edges.push_back({random_vertex(random, n), random_vertex(random, n), random.uniform(0.01, 1)});
  }
  return {n, std::move(edges)};
}

inline WeightedGraph random_tree(Index n, Random& random) {
  std::vector<WeightedEdge> edges;
  for (Index v = 1; v < n; ++v) edges.push_back({v, random_vertex(random, v), 1.0});
  return {n, std::move(edges)};
}

/// Points in the unit square, joined where closer than `radius`.
inline WeightedGraph random_geometric(Index n, double radius, Random& random) {
  std::vector<std::pair<double, double>> points(n);
  for (auto& point : points) point = {random.uniform(), random.uniform()};
  std::vector<WeightedEdge> edges;
  for (Index i = 0; i < n; ++i) {
    for (Index j = i + 1; j < n; ++j) {
      const double distance =
          std::hypot(points[i].first - points[j].first, points[i].second - points[j].second);
      if (distance < radius) edges.push_back({i, j, std::exp(-distance / radius)});
    }
  }
  return {n, std::move(edges)};
}

/// The same edges with weights spread evenly over `decades` powers of ten around 1.
inline WeightedGraph spread_weights(const WeightedGraph& graph, double decades, Random& random) {
  std::vector<WeightedEdge> edges(graph.edges().begin(), graph.edges().end());
  for (auto& edge : edges) edge.weight = std::pow(10.0, random.uniform(-decades / 2, decades / 2));
  return {graph.vertex_count(), std::move(edges)};
}

/// Both graphs side by side, not connected.
inline WeightedGraph disjoint_union(const WeightedGraph& first, const WeightedGraph& second) {
  std::vector<WeightedEdge> edges(first.edges().begin(), first.edges().end());
  const Index shift = first.vertex_count();
  for (const auto& edge : second.edges()) {
    edges.push_back({edge.from + shift, edge.to + shift, edge.weight});
  }
  return {shift + second.vertex_count(), std::move(edges)};
}

/// Vertex v becomes permutation[v].
inline WeightedGraph relabel(const WeightedGraph& graph, const std::vector<Index>& permutation) {
  std::vector<WeightedEdge> edges;
  for (const auto& edge : graph.edges()) {
    edges.push_back({permutation[edge.from], permutation[edge.to], edge.weight});
  }
  return {graph.vertex_count(), std::move(edges)};
}

inline std::vector<Index> random_permutation(Index n, Random& random) {
  std::vector<Index> permutation(n);
  std::iota(permutation.begin(), permutation.end(), 0);
  for (Index k = n; k > 1; --k)
    std::swap(permutation[k - 1], permutation[random_vertex(random, k)]);
  return permutation;
}

}  // namespace isotherm_test
