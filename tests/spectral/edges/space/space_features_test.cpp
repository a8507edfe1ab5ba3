#include "edges/space/space_features.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "spectral/edges/space/points.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

constexpr std::size_t kInPlane = 0, kInSpace = 1;

TEST(SpaceFeatures, TellNearFromFar) {
  Random random(8);
  const auto points = points_in_ball(100, 3, random);
  const Index false_count = 30;
  const auto graph = contacts(points, 0.45, false_count, random);
  const auto ones = equal_worth(graph);
  auto trust = ones;
  std::fill(trust.end() - false_count, trust.end(), 0.0);
  const std::vector<VertexPair> pairs = {{0, 1}};
  const auto found = space_features(graph, ones, {trust, 30.0}, pairs, {.threads = 1}).at(kInSpace);
  ASSERT_EQ(found.edges.size(), graph.edges().size());
  ASSERT_EQ(found.pairs.size(), 1U);
  std::vector<double> near, far;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto& [from, to, weight] = graph.edge(e);
    const double distance = (points.col(from) - points.col(to)).norm();
    if (distance < 0.45) near.push_back(found.edges[e]);
    if (distance > 0.6) far.push_back(found.edges[e]);
  }
  double wins = 0.0;
  for (const double odds : far) {
    wins += static_cast<double>(
        std::count_if(near.begin(), near.end(), [odds](double other) { return other < odds; }));
  }
  EXPECT_GT(wins / static_cast<double>(near.size() * far.size()), 0.95);
  const auto again = space_features(graph, ones, {trust, 30.0}, pairs, {.threads = 2}).at(kInSpace);
  EXPECT_EQ(again.edges, found.edges);
  EXPECT_EQ(again.pairs, found.pairs);
}

/// Pearson's.
double correlation(const std::vector<double>& one, const std::vector<double>& other) {
  const Eigen::Map<const Eigen::ArrayXd> x(one.data(), static_cast<Eigen::Index>(one.size()));
  const Eigen::Map<const Eigen::ArrayXd> y(other.data(), static_cast<Eigen::Index>(other.size()));
  const Eigen::ArrayXd dx = x - x.mean(), dy = y - y.mean();
  return (dx * dy).sum() / std::sqrt(dx.square().sum() * dy.square().sum());
}

TEST(SpaceFeatures, HardlyDependOnTheSeedAndTheOrderOfVertices) {
  Random random(12);
  const auto graph = contacts(points_in_ball(120, 3, random), 0.45, 30, random);
  const auto ones = equal_worth(graph);
  auto trust = ones;
  std::fill(trust.end() - 30, trust.end(), 0.0);
  std::vector<WeightedEdge> edges;
  for (const auto& [from, to, weight] : graph.edges()) edges.push_back({119 - to, 119 - from, 1.0});
  const WeightedGraph turned(120, edges);
  const auto found = space_features(graph, ones, {trust, 30.0}, {}, {.seed = 1}).at(kInSpace);
  const auto other = space_features(graph, ones, {trust, 30.0}, {}, {.seed = 100}).at(kInSpace);
  const auto back = space_features(turned, ones, {trust, 30.0}, {}, {.seed = 1}).at(kInSpace);
  EXPECT_GT(correlation(found.edges, other.edges), 0.95);
  EXPECT_GT(correlation(found.edges, back.edges), 0.95);
}

TEST(SpaceFeatures, DoubtAllEdgesOfAVertexThatLeadApart) {
  // Where the vertex begins would vouch for the edge there, if it began there in each run.
  std::vector<WeightedEdge> edges;
  for (Index y = 0; y < 3; ++y) {
    for (Index x = 0; x < 30; ++x) {
      const Index v = y * 30 + x;
      if (x + 1 < 30) edges.push_back({v, v + 1, 1.0});
      if (y + 1 < 3) edges.push_back({v, v + 30, 1.0});
      if (x + 1 < 30 && y + 1 < 3) edges.push_back({v, v + 31, 1.0});
      if (x > 0 && y + 1 < 3) edges.push_back({v, v + 29, 1.0});
    }
  }
  for (const Index v : {0, 45, 29}) edges.push_back({90, v, 1.0});
  const WeightedGraph graph(91, edges);
  const auto ones = equal_worth(graph);
  auto trust = ones;
  std::fill(trust.end() - 3, trust.end(), 0.0);
  const auto found = space_features(graph, ones, {trust, 3.0}, {}, {}).at(kInPlane);
  for (std::size_t k = found.edges.size() - 3; k < found.edges.size(); ++k) {
    EXPECT_GT(found.edges[k], 3.0);
  }
}

TEST(SpaceFeatures, TakePartsAndRepeatedEdges) {
  const auto parts = disjoint_union(ring_graph(12), complete_graph(6));
  std::vector<WeightedEdge> edges(parts.edges().begin(), parts.edges().end());
  edges.insert(edges.end(), parts.edges().begin(), parts.edges().end());
  const WeightedGraph twice(parts.vertex_count(), edges);
  const auto ones = equal_worth(twice);
  const std::vector<VertexPair> pairs = {{0, 6}, {0, 17}};
  for (const auto& trust : {ones, equal_worth(twice, 0.0)}) {
    for (const auto& found : space_features(twice, ones, {trust, 0.0}, pairs, {})) {
      for (const double odds : found.edges) EXPECT_LT(std::abs(odds), 14.0);
      for (const double odds : found.pairs) EXPECT_LT(std::abs(odds), 14.0);
    }
  }
}

TEST(SpaceFeatures, AreNotThoseOfFewOrManyVertices) {
  const auto few = complete_graph(9), many = ring_graph(1401);
  for (const auto& graph : {WeightedGraph(), few, many}) {
    const auto ones = equal_worth(graph);
    EXPECT_TRUE(space_features(graph, ones, {ones, 0.0}, {}, {}).empty());
  }
}

TEST(SpaceFeatures, LeaveOutVerticesWithoutEdges) {
  const auto ring = ring_graph(20);
  const auto apart = disjoint_union(WeightedGraph(3, {}), ring);
  const auto ones = equal_worth(ring);
  const std::vector<VertexPair> pairs = {{0, 10}}, shifted = {{3, 13}};
  const auto found = space_features(ring, ones, {ones, 1.0}, pairs, {}).at(kInPlane);
  const auto other = space_features(apart, ones, {ones, 1.0}, shifted, {}).at(kInPlane);
  EXPECT_EQ(found.edges, other.edges);
  EXPECT_EQ(found.pairs, other.pairs);
}

}  // namespace
}  // namespace isotherm::spectral::detail
