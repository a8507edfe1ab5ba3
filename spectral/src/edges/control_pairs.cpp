#include "edges/control_pairs.hpp"

#include <algorithm>
#include <utility>

#include "isotherm/base/random.hpp"

namespace isotherm::spectral::detail {
namespace {

std::vector<Index> vertices_with_edges(const WeightedGraph& graph) {
  std::vector<Index> vertices;
  for (Index vertex = 0; vertex < graph.vertex_count(); ++vertex) {
    if (!graph.neighbours(vertex).empty()) vertices.push_back(vertex);
  }
  return vertices;
}

bool are_joined(const WeightedGraph& graph, Index first, Index second) {
  const auto near = graph.neighbours(first);
  return std::any_of(near.begin(), near.end(),
                     [second](const Neighbour& n) { return n.vertex == second; });
}

bool have_common_neighbour(const WeightedGraph& graph, Index first, Index second) {
  const auto near = graph.neighbours(first);
  return std::any_of(near.begin(), near.end(),
                     [&](const Neighbour& n) { return are_joined(graph, n.vertex, second); });
}

Index end_of_walk(const WeightedGraph& graph, Index vertex, Random& random) {
  constexpr std::uint64_t kShortest = 3, kLongest = 8;
  for (auto steps = kShortest + random.index(kLongest - kShortest + 1); steps > 0; --steps) {
    const auto near = graph.neighbours(vertex);
    vertex = near[random.index(near.size())].vertex;
  }
  return vertex;
}

}  // namespace

std::vector<VertexPair> control_pairs(const WeightedGraph& graph, ControlGroup control,
                                      std::uint64_t seed) {
  constexpr std::size_t kMost = 100'000;
  constexpr std::size_t kPerVertex = 50;
  const auto vertices = vertices_with_edges(graph);
  Random random(seed);
  std::vector<VertexPair> pairs;
  for (std::size_t k = std::min(kMost, kPerVertex * vertices.size()); k > 0; --k) {
    const bool near = control == ControlGroup::near;
    VertexPair pair;
    pair.from = vertices[random.index(vertices.size())];
    pair.to =
        near ? end_of_walk(graph, pair.from, random) : vertices[random.index(vertices.size())];
    if (pair.from == pair.to || are_joined(graph, pair.from, pair.to)) continue;
    if (near && have_common_neighbour(graph, pair.from, pair.to)) continue;
    pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(), [](const VertexPair& a, const VertexPair& b) {
    return std::pair(a.from, a.to) < std::pair(b.from, b.to);
  });
  return pairs;
}

}  // namespace isotherm::spectral::detail
