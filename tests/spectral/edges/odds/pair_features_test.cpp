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
  const auto found = pair_features(graph, all, pairs, given, {});
  ASSERT_EQ(found.edges.rows(), 12);
  ASSERT_EQ(found.edges.cols(), 5);
  // 0 - 1: common are 2, 3, 4 and 5; each has four others.
  const Eigen::RowVectorXd first{{7.0, 2.0, std::log(4.5), std::log(4.0), std::log(4.0)}};
  EXPECT_TRUE(found.edges.row(0).isApprox(first, 1e-14)) << found.edges.row(0);
  // 5 - 0 without itself: by 1; one left for 5, which counts as three.
  const Eigen::RowVectorXd last{{7.0, 2.0, std::log(1.5), std::log(3.0), std::log(4.0)}};
  EXPECT_TRUE(found.edges.row(10).isApprox(last, 1e-14)) << found.edges.row(10);
  const Eigen::RowVectorXd pair{{8.0, 2.0, std::log(2.5), std::log(3.0), std::log(4.0)}};
  EXPECT_TRUE(found.pairs.row(0).isApprox(pair, 1e-14)) << found.pairs.row(0);
}

TEST(PairFeatures, EdgesWithoutTrustAreNotThere) {
  const auto ring = ring_graph(12);
  std::vector<double> trust(12, 1.0);
  trust[6] = 0.0;
  const auto found = pair_features(ring, trust, {}, {}, {.most_steps = 15});
  EXPECT_EQ(found.edges(0, 0), 16.0);  // the way round is cut
  EXPECT_EQ(found.edges(6, 0), 11.0);
  EXPECT_EQ(found.edges(0, 1), std::log(0.5));
  EXPECT_EQ(found.pairs.rows(), 0);
}

}  // namespace
}  // namespace isotherm::spectral::detail
