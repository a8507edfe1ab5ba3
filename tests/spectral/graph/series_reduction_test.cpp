#include "graph/series_reduction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;
using testing::Each;
using testing::ElementsAre;

constexpr Index kNone = SeriesReduction::kNone;

std::vector<bool> none(const WeightedGraph& graph) {
  return std::vector<bool>(graph.edges().size(), false);
}

TEST(SeriesReduction, JoinsTheEdgesOfAChain) {
  // Two ends, 0 and 3, joined by an edge, by a chain of three and by one of two.
  const WeightedGraph graph(
      5, {{0, 3, 2.0}, {1, 2, 1.0}, {0, 1, 0.5}, {3, 2, 0.25}, {0, 4, 1.0}, {4, 3, 1.0}});
  const auto reduction = reduce_series(graph, none(graph));
  EXPECT_THAT(reduction.chains, ElementsAre(0, 1, 1, 1, 2, 2));
  EXPECT_THAT(reduction.lengths, ElementsAre(1.0, 3.0, 2.0));
  ASSERT_EQ(reduction.graph.edge_count(), 3);
  EXPECT_EQ(reduction.graph.vertex_count(), 5);
  EXPECT_DOUBLE_EQ(reduction.graph.edge(0).weight, 2.0);
  EXPECT_DOUBLE_EQ(reduction.graph.edge(1).weight, 3.0 / (1.0 + 2.0 + 4.0));
  EXPECT_DOUBLE_EQ(reduction.graph.edge(2).weight, 1.0);
  for (const auto& edge : reduction.graph.edges()) EXPECT_EQ(edge.from + edge.to, 3);
}

TEST(SeriesReduction, LeavesOutWhatClosesOnItself) {
  EXPECT_THAT(reduce_series(ring_graph(9), none(ring_graph(9))).chains, Each(kNone));
  // A ring that hangs on a vertex of a complete graph, and a self-loop.
  const auto complete = complete_graph(4);
  std::vector<WeightedEdge> edges(complete.edges().begin(), complete.edges().end());
  edges.insert(edges.end(), {{0, 4, 1.0}, {4, 5, 1.0}, {5, 0, 1.0}, {1, 1, 1.0}});
  const WeightedGraph graph(6, edges);
  const auto reduction = reduce_series(graph, none(graph));
  EXPECT_THAT(reduction.chains, ElementsAre(0, 1, 2, 3, 4, 5, kNone, kNone, kNone, kNone));
}

TEST(SeriesReduction, LeavesOutMarkedEdges) {
  // Without the marked diagonal, a square with the other diagonal has two chains.
  const auto graph = complete_graph(4);  // 01 02 03 12 13 23
  auto marked = none(graph);
  marked[1] = true;
  const auto reduction = reduce_series(graph, marked);
  EXPECT_THAT(reduction.chains, ElementsAre(0, kNone, 0, 1, 2, 1));
  EXPECT_EQ(reduce_series(WeightedGraph(), {}).graph.edge_count(), 0);
}

TEST(SeriesReduction, KeepsAGraphWithoutChains) {
  const auto graph = complete_graph(6);
  const auto reduction = reduce_series(graph, none(graph));
  ASSERT_EQ(reduction.graph.edge_count(), graph.edge_count());
  for (Index e = 0; e < graph.edge_count(); ++e) {
    EXPECT_EQ(reduction.chains[e], e);
    EXPECT_EQ(reduction.graph.edge(e).from, graph.edge(e).from);
    EXPECT_EQ(reduction.graph.edge(e).to, graph.edge(e).to);
  }
}

}  // namespace
}  // namespace isotherm::spectral::detail
