#include "edges/space/space_features.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "spectral/edges/space/points.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

TEST(SpaceFeatures, TellNearFromFar) {
  Random random(8);
  const auto points = points_in_ball(100, 3, random);
  const Index false_count = 30;
  const auto graph = contacts(points, 0.45, false_count, random);
  const auto ones = equal_worth(graph);
  auto trust = ones;
  std::fill(trust.end() - false_count, trust.end(), 0.0);
  const std::vector<VertexPair> pairs = {{0, 1}};
  const auto found = space_features(graph, ones, 3, {trust, 30.0}, pairs, {.threads = 1});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->edges.size(), graph.edges().size());
  ASSERT_EQ(found->pairs.size(), 1U);
  std::vector<double> near, far;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto& [from, to, weight] = graph.edge(e);
    const double distance = (points.col(from) - points.col(to)).norm();
    if (distance < 0.45) near.push_back(found->edges[e]);
    if (distance > 0.6) far.push_back(found->edges[e]);
  }
  double wins = 0.0;
  for (const double odds : far) {
    wins += static_cast<double>(
        std::count_if(near.begin(), near.end(), [odds](double other) { return other < odds; }));
  }
  EXPECT_GT(wins / static_cast<double>(near.size() * far.size()), 0.95);
  const auto again = space_features(graph, ones, 3, {trust, 30.0}, pairs, {.threads = 2});
  EXPECT_EQ(again->edges, found->edges);
  EXPECT_EQ(again->pairs, found->pairs);
}

TEST(SpaceFeatures, AreNotThoseOfFewOrManyVertices) {
  const auto few = complete_graph(9), many = ring_graph(1401);
  for (const auto& graph : {WeightedGraph(), few, many}) {
    const auto ones = equal_worth(graph);
    EXPECT_FALSE(space_features(graph, ones, 2, {ones, 0.0}, {}, {}));
  }
}

TEST(SpaceFeatures, LeaveOutVerticesWithoutEdges) {
  const auto ring = ring_graph(20);
  const auto apart = disjoint_union(WeightedGraph(3, {}), ring);
  const auto ones = equal_worth(ring);
  const std::vector<VertexPair> pairs = {{0, 10}}, shifted = {{3, 13}};
  const auto found = space_features(ring, ones, 2, {ones, 1.0}, pairs, {});
  const auto other = space_features(apart, ones, 2, {ones, 1.0}, shifted, {});
  ASSERT_TRUE(found && other);
  EXPECT_EQ(found->edges, other->edges);
  EXPECT_EQ(found->pairs, other->pairs);
}

}  // namespace
}  // namespace isotherm::spectral::detail
