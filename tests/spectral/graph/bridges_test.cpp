#include "graph/bridges.hpp"

#include <gtest/gtest.h>

#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

std::vector<bool> by_removal(const WeightedGraph& graph) {
  std::vector<bool> bridges;
  const Index components = connected_components(graph).count;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    std::vector<bool> keep(graph.edges().size(), true);
    keep[e] = false;
    bridges.push_back(connected_components(filter_edges(graph, keep)).count > components);
  }
  return bridges;
}

TEST(Bridges, AgreeWithTakingEachEdgeOut) {
  Random random(5);
  for (int trial = 0; trial < 60; ++trial) {
    const Index n = 2 + random_vertex(random, 12);
    std::vector<WeightedEdge> edges;
    for (Index k = random_vertex(random, 20); k > 0; --k) {
      edges.push_back({random_vertex(random, n), random_vertex(random, n), 1.0});
    }
    const WeightedGraph graph(n, std::move(edges));
    EXPECT_EQ(find_bridges(graph), by_removal(graph));
  }
}

TEST(Bridges, LongPathsAndNoEdges) {
  EXPECT_TRUE(find_bridges(WeightedGraph()).empty());
  EXPECT_EQ(find_bridges(path_graph(100'000)), std::vector<bool>(99'999, true));
  EXPECT_EQ(find_bridges(ring_graph(50)), std::vector<bool>(50, false));
}

}  // namespace
}  // namespace isotherm::spectral::detail
