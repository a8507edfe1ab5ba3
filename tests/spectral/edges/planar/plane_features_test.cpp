#include "edges/planar/plane_features.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

WalkAffinityOptions walks() { return {.scale = 2.0, .horizon = 12}; }

TEST(PlaneFeatures, TellWhatShortcutsCross) {
  const Index side = 15;
  const auto grid = grid_graph(side, side);
  std::vector<WeightedEdge> edges(grid.edges().begin(), grid.edges().end());
  const auto at = [](Index x, Index y) { return y * 15 + x; };
  edges.push_back({at(7, 7), at(8, 8), 1.0});  // across one cell: fits
  edges.push_back({at(4, 4), at(4, 6), 1.0});  // across one edge
  edges.push_back({at(3, 3), at(9, 8), 1.0});  // across many
  const WeightedGraph graph(grid.vertex_count(), edges);
  const std::vector<VertexPair> pairs = {{at(3, 3), at(10, 10)}, {at(7, 7), at(4, 10)}};
  const auto found = plane_features(graph, equal_worth(graph), pairs, walks());
  ASSERT_TRUE(found);
  const auto crossings = found->crossings.edges.end() - 3;
  EXPECT_EQ(crossings[0], 0.0);
  EXPECT_EQ(crossings[1], 1.0);
  EXPECT_GT(crossings[2], 4.0);
  EXPECT_EQ(*std::max_element(found->crossings.edges.begin(), crossings), 0.0);
  EXPECT_EQ(found->few_crossings.edges.end()[-2], 1.0);
  EXPECT_EQ(found->few_crossings.edges.back(), 3.0);
  ASSERT_EQ(found->crossings.pairs.size(), 2U);
  EXPECT_GT(*std::min_element(found->crossings.pairs.begin(), found->crossings.pairs.end()), 1.0);
  // Across a cell the ends are near within the grid; across many they are not.
  EXPECT_LT(found->distances.edges.end()[-3], found->distances.edges.back());
}

TEST(PlaneFeatures, SayNothingWhereCrossingsDoNot) {
  const auto dense = complete_graph(12);
  const std::vector<VertexPair> pairs = {{0, 7}, {1, 8}};
  EXPECT_FALSE(plane_features(dense, equal_worth(dense), pairs, walks()));
  // Around a ring everything can be joined on the outside.
  const auto ring = ring_graph(30);
  EXPECT_FALSE(plane_features(ring, equal_worth(ring), pairs, walks()));
  EXPECT_FALSE(plane_features(WeightedGraph(), {}, {}, walks()));
}

}  // namespace
}  // namespace isotherm::spectral::detail
