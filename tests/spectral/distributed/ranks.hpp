#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "isotherm/spectral/distributed.hpp"
#include "spectral/graphs.hpp"

/// What the distributed tests have in common. Every test runs on every rank at once, whatever
/// their number, and holds what its rank was given against what one machine finds.
namespace isotherm_test {

namespace distributed = isotherm::spectral::distributed;

/// The session of the test program.
const distributed::Session& session();

/// This rank's share of items that all ranks know.
template <class Item>
std::span<const Item> share(std::span<const Item> items) {
  const auto ranks = static_cast<std::size_t>(session().size());
  const auto rank = static_cast<std::size_t>(session().rank());
  const std::size_t begin = items.size() * rank / ranks, end = items.size() * (rank + 1) / ranks;
  return items.subspan(begin, end - begin);
}

/// Where the share begins among all items.
template <class Item>
std::size_t share_begin(const std::vector<Item>& items) {
  return items.size() * static_cast<std::size_t>(session().rank()) /
         static_cast<std::size_t>(session().size());
}

/// A graph that every rank knows, in parts.
inline distributed::Graph distribute(const WeightedGraph& graph) {
  return distributed::Graph::from_edges(session(), graph.vertex_count(), share(graph.edges()));
}

/// Kinds of graphs that the serial tests use: like pose graphs, meshes, trees, disconnected ones.
inline std::vector<WeightedGraph> shapes(Random& random) {
  return {loopy_path(40, 8, random), grid_graph(7, 6), random_tree(40, random),
          random_geometric(40, 0.3, random),
          disjoint_union(loopy_path(20, 4, random), grid_graph(5, 4))};
}

/// All shapes in one graph that is not connected, and one that is: few graphs, since what ranks
/// have to say to each other takes long where they share cores.
inline std::vector<WeightedGraph> joined_shapes(Random& random) {
  WeightedGraph all;
  for (const auto& shape : shapes(random)) all = disjoint_union(all, shape);
  return {all, random_geometric(120, 0.2, random)};
}

}  // namespace isotherm_test
