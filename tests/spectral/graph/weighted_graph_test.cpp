#include "isotherm/spectral/graph/weighted_graph.hpp"

#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral {
namespace {

using testing::ElementsAre;

TEST(WeightedGraph, EmptyGraphHasNoComponents) {
  for (const auto& graph : {WeightedGraph(), WeightedGraph(0, {})}) {
    EXPECT_EQ(graph.vertex_count(), 0);
    EXPECT_EQ(graph.edge_count(), 0);
    EXPECT_EQ(connected_components(graph).count, 0);
    EXPECT_EQ(weighted_degrees(graph).size(), 0);
  }
}

TEST(WeightedGraph, KeepsIdsOfParallelEdges) {
  const WeightedGraph graph(2, {{0, 1, 1.0}, {1, 0, 2.0}, {0, 1, 4.0}});
  ASSERT_EQ(graph.edge_count(), 3);
  EXPECT_EQ(graph.edge(1).from, 1);
  std::vector<Index> ids;
  for (const auto& neighbour : graph.neighbours(0)) {
    EXPECT_EQ(neighbour.vertex, 1);
    ids.push_back(neighbour.edge);
  }
  EXPECT_THAT(ids, ElementsAre(0, 1, 2));
  EXPECT_EQ(weighted_degrees(graph), Eigen::Vector2d(7.0, 7.0));
}

TEST(WeightedGraph, SelfLoopsHaveNoDegree) {
  const WeightedGraph graph(2, {{0, 0, 5.0}, {0, 1, 2.0}});
  EXPECT_EQ(graph.neighbours(0).size(), 2u);
  EXPECT_EQ(weighted_degrees(graph), Eigen::Vector2d(2.0, 2.0));
}

TEST(WeightedGraph, ComponentsAreNumberedBySmallestVertex) {
  const WeightedGraph graph(6, {{4, 1, 1.0}, {2, 5, 1.0}, {5, 0, 1.0}});
  const auto components = connected_components(graph);
  EXPECT_EQ(components.count, 3);
  EXPECT_THAT(components.label, ElementsAre(0, 1, 0, 2, 1, 0));
}

TEST(WeightedGraph, RejectsBadEdges) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double weight : {0.0, -1.0, infinity, nan}) {
    EXPECT_THROW(WeightedGraph(2, {{0, 1, weight}}), InvalidArgument) << weight;
  }
  EXPECT_THROW(WeightedGraph(2, {{0, 2, 1.0}}), InvalidArgument);
  EXPECT_THROW(WeightedGraph(2, {{-1, 1, 1.0}}), InvalidArgument);
  EXPECT_THROW(WeightedGraph(-1, {}), InvalidArgument);
  try {
    WeightedGraph(2, {{0, 1, 1.0}, {0, 1, -2.0}});
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_EQ(error.option(), "edges[1]");
  }
}

TEST(WeightedGraph, FilterKeepsTheVertices) {
  const WeightedGraph graph(3, {{0, 1, 1.0}, {1, 2, 2.0}, {0, 2, 3.0}});
  const auto kept = filter_edges(graph, {false, true, true});
  EXPECT_EQ(kept.vertex_count(), 3);
  ASSERT_EQ(kept.edge_count(), 2);
  EXPECT_EQ(kept.edge(0).weight, 2.0);
  EXPECT_EQ(kept.edge(1).weight, 3.0);
  EXPECT_THROW(filter_edges(graph, {true}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::spectral
