#include "edges/odds/pair_features.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

TEST(PairFeatures, ByHand) {
  // A complete graph of five, and a vertex that hangs on two of them.
  const auto five = complete_graph(5);
  std::vector<WeightedEdge> edges(five.edges().begin(), five.edges().end());
  edges.push_back({5, 0, 1.0});
  edges.push_back({5, 1, 1.0});
  const WeightedGraph graph(6, edges);
  const std::vector<VertexPair> pairs = {{5, 4}};
  const std::vector<double> all(edges.size(), 1.0);
  const std::vector<Measured> given = {{std::vector<double>(edges.size(), 7.0), {8.0}}};
  const auto found = pair_features(graph, {all, all}, pairs, given, {});
  ASSERT_EQ(found.edges.rows(), 12);
  ASSERT_EQ(found.edges.cols(), 6);
  const auto row = [](double steps, double common, double fewer, double more) {
    const double none = -std::log(common + 0.5);
    return Eigen::RowVector<double, 5>{{steps, std::log(fewer + 1) + none,
                                        std::log(more + 1) + none, std::log(fewer + 1),
                                        std::log(more + 1)}};
  };
  // 0 - 1: common are 2, 3, 4 and 5; each has four others.
  EXPECT_TRUE(found.edges.row(0).tail(5).isApprox(row(2, 4, 4, 4), 1e-14)) << found.edges.row(0);
  // 5 - 0 without itself: by 1; one left for 5, which counts as three.
  EXPECT_TRUE(found.edges.row(10).tail(5).isApprox(row(2, 1, 3, 4), 1e-14)) << found.edges.row(10);
  EXPECT_TRUE(found.pairs.row(0).tail(5).isApprox(row(2, 2, 3, 4), 1e-14)) << found.pairs.row(0);
  EXPECT_EQ(found.edges(0, 0), 7.0);
  EXPECT_EQ(found.pairs(0, 0), 8.0);
}

TEST(PairFeatures, NeighboursCountAsFarAsTheirEdgesAreTrue) {
  const auto graph = complete_graph(6);
  const std::vector<double> truth(graph.edges().size(), 0.9);
  const auto found = pair_features(graph, {truth, truth}, {}, {}, {});
  EXPECT_NEAR(found.edges(0, 3), std::log(4 * 0.9 + 1), 1e-14);
  EXPECT_NEAR(found.edges(0, 1), std::log(4 * 0.9 + 1) - std::log(4 * 0.81 + 0.5), 1e-14);
}

TEST(PairFeatures, WalksCrossNoEdgeWithoutTrust) {
  const auto ring = ring_graph(12);
  const std::vector<double> truth(12, 1.0);
  auto trust = truth;
  trust[6] = 0.0;
  const auto found = pair_features(ring, {truth, trust}, {}, {}, {.most_steps = 15});
  EXPECT_EQ(found.edges(0, 0), 16.0);  // the way round is cut
  EXPECT_EQ(found.edges(6, 0), 11.0);
  EXPECT_EQ(found.pairs.rows(), 0);
}

TEST(PairFeatures, LevelOffAtTheMiddleOfThePairs) {
  Measured measured{{1.0, 9.0, 4.0}, {3.0, 8.0, 5.0}};
  level_off(measured);
  EXPECT_EQ(measured.edges, (std::vector{1.0, 5.0, 4.0}));
  EXPECT_EQ(measured.pairs, (std::vector{3.0, 5.0, 5.0}));
  const auto path = path_graph(9);
  const std::vector<double> all(8, 1.0);
  const std::vector<VertexPair> pairs = {{0, 2}, {0, 4}, {0, 8}};
  const auto found = pair_features(path, {all, all}, pairs, {}, {});
  EXPECT_EQ(found.pairs.col(0), (Eigen::Vector3d{2.0, 4.0, 4.0}));
  EXPECT_EQ(found.edges(0, 0), 4.0);
}

}  // namespace
}  // namespace isotherm::spectral::detail
