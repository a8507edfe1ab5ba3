#include "graph/simple_graph.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm::spectral::detail {
namespace {

using testing::ElementsAre;

TEST(SimpleGraph, MergesParallelEdgesAndDropsSelfLoops) {
  const WeightedGraph graph(
      4, {{2, 1, 1.0}, {0, 0, 5.0}, {1, 2, 0.5}, {0, 3, 2.0}, {2, 1, 0.25}, {0, 1, 1.0}});
  const auto simple = merge_parallel_edges(graph);
  EXPECT_THAT(simple.merged, ElementsAre(2, SimpleGraph::kNone, 2, 1, 2, 0));
  ASSERT_EQ(simple.graph.edge_count(), 3);
  EXPECT_EQ(simple.graph.vertex_count(), 4);
  EXPECT_EQ(simple.graph.edge(2).weight, 1.75);
}

TEST(SimpleGraph, WeightsDoNotOverflow) {
  constexpr double kHuge = std::numeric_limits<double>::max();
  const WeightedGraph graph(2, {{0, 1, kHuge}, {1, 0, kHuge}});
  EXPECT_EQ(merge_parallel_edges(graph).graph.edge(0).weight, kHuge);
  EXPECT_EQ(merge_parallel_edges(WeightedGraph()).graph.edge_count(), 0);
}

}  // namespace
}  // namespace isotherm::spectral::detail
