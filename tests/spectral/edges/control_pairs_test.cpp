#include "edges/control_pairs.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

std::set<Index> within(const WeightedGraph& graph, Index start, int steps) {
  std::set<Index> ball = {start};
  for (; steps > 0; --steps) {
    for (const Index vertex : std::set<Index>(ball)) {
      for (const auto& neighbour : graph.neighbours(vertex)) ball.insert(neighbour.vertex);
    }
  }
  return ball;
}

bool in_order(const std::vector<VertexPair>& pairs) {
  return std::is_sorted(pairs.begin(), pairs.end(),
                        [](const VertexPair& a, const VertexPair& b) { return a.from < b.from; });
}

TEST(ControlPairs, AnywhereButNotAtAnEdge) {
  const auto grid = grid_graph(12, 12);
  const auto pairs = control_pairs(grid, ControlGroup::anywhere, 1);
  EXPECT_GT(pairs.size(), 6000u);
  EXPECT_TRUE(in_order(pairs));
  double mean = 0.0;
  for (const auto& pair : pairs) {
    EXPECT_FALSE(within(grid, pair.from, 1).contains(pair.to));
    mean += static_cast<double>(pair.to) / static_cast<double>(pairs.size());
  }
  EXPECT_NEAR(mean, 71.5, 3.0);
}

TEST(ControlPairs, NearIsThreeToEightSteps) {
  const auto grid = grid_graph(30, 30);
  const auto pairs = control_pairs(grid, ControlGroup::near, 1);
  EXPECT_GT(pairs.size(), 5000u);
  EXPECT_TRUE(in_order(pairs));
  for (std::size_t k = 0; k < pairs.size(); k += 25) {
    EXPECT_FALSE(within(grid, pairs[k].from, 2).contains(pairs[k].to));
    EXPECT_TRUE(within(grid, pairs[k].from, 8).contains(pairs[k].to));
  }
}

TEST(ControlPairs, WhereThereAreNone) {
  for (const auto control : {ControlGroup::anywhere, ControlGroup::near}) {
    EXPECT_TRUE(control_pairs(WeightedGraph(), control, 1).empty());
    EXPECT_TRUE(control_pairs(WeightedGraph(5, {}), control, 1).empty());
    EXPECT_TRUE(control_pairs(complete_graph(8), control, 1).empty());
    // Vertices without an edge take no part.
    for (const auto& pair :
         control_pairs(disjoint_union(WeightedGraph(9, {}), ring_graph(20)), control, 1)) {
      EXPECT_GE(std::min(pair.from, pair.to), 9);
    }
  }
}

}  // namespace
}  // namespace isotherm::spectral::detail
