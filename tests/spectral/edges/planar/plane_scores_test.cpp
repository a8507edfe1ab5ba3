#include "edges/planar/plane_scores.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

WalkAffinityOptions walks() { return {.scale = 2.0, .horizon = 12}; }

TEST(PlaneScores, RankShortcutsByWhatTheyCross) {
  const Index side = 15;
  const auto grid = grid_graph(side, side);
  std::vector<WeightedEdge> edges(grid.edges().begin(), grid.edges().end());
  const auto at = [](Index x, Index y) { return y * 15 + x; };
  edges.push_back({at(7, 7), at(8, 8), 1.0});  // across one cell: fits
  edges.push_back({at(4, 4), at(4, 6), 1.0});  // across one edge
  edges.push_back({at(3, 3), at(9, 8), 1.0});  // across many
  const WeightedGraph graph(grid.vertex_count(), edges);
  const std::vector<VertexPair> pairs = {{at(3, 3), at(10, 10)}, {at(7, 7), at(4, 10)}};
  const auto scores = plane_scores(graph, equal_worth(graph), equal_worth(graph), pairs, walks());
  ASSERT_TRUE(scores);
  const auto first = scores->edges.end() - 3;
  EXPECT_LT(first[0], first[1]);
  EXPECT_LT(first[1], first[2]);
  // Only the one that fits scores like an edge of the grid.
  EXPECT_GT(first[1], *std::max_element(scores->edges.begin(), first));
  EXPECT_EQ(scores->pairs.size(), 2U);
  EXPECT_GT(*std::min_element(scores->pairs.begin(), scores->pairs.end()), first[1]);
}

TEST(PlaneScores, SayNothingWhereCrossingsDoNot) {
  const auto dense = complete_graph(12);
  const std::vector<VertexPair> pairs = {{0, 7}, {1, 8}};
  EXPECT_FALSE(plane_scores(dense, equal_worth(dense), equal_worth(dense), pairs, walks()));
  // Around a ring everything can be joined on the outside.
  const auto ring = ring_graph(30);
  EXPECT_FALSE(plane_scores(ring, equal_worth(ring), equal_worth(ring), pairs, walks()));
  EXPECT_FALSE(plane_scores(WeightedGraph(), {}, {}, {}, walks()));
}

}  // namespace
}  // namespace isotherm::spectral::detail
