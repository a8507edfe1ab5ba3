#include "localize/problem/point_grid.hpp"

#include <gtest/gtest.h>

#include "isotherm/geometry/points/neighbour_graph.hpp"

namespace isotherm::network::detail {
namespace {

TEST(NearPairs, AreTheEdgesOfARadiusGraph) {
  for (const int dimension : {2, 3}) {
    const Eigen::MatrixXd points = Eigen::MatrixXd::Random(dimension, 400);
    const auto graph = geometry::radius_graph(points, 0.3);
    const auto pairs = near_pairs(points, 0.3);
    ASSERT_EQ(pairs.size(), graph.edges().size());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      EXPECT_EQ(pairs[k].first, graph.edges()[k].from);
      EXPECT_EQ(pairs[k].second, graph.edges()[k].to);
    }
  }
}

TEST(NearPairs, OfAHeapAreNotAll) {
  EXPECT_LT(near_pairs(Eigen::MatrixXd::Zero(2, 3000), 1.0).size(), 1'000'000);
  EXPECT_EQ(near_pairs(Eigen::MatrixXd::Zero(2, 100), 1.0).size(), 4950);
  EXPECT_TRUE(near_pairs(Eigen::MatrixXd(2, 0), 1.0).empty());
}

TEST(NearPairs, OfAHeapAreAnEvenSampleOfTheWantedOnes) {
  const auto odd = [](std::int32_t a, std::int32_t b) { return a == 0 && b % 2 == 1; };
  const auto pairs = near_pairs(Eigen::MatrixXd::Zero(2, 3000), 1.0, odd);
  ASSERT_EQ(pairs.size(), 300);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    EXPECT_EQ(pairs[k].second, static_cast<std::int32_t>(10 * k + 1));
  }
}

}  // namespace
}  // namespace isotherm::network::detail
