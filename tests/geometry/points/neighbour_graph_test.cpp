#include "isotherm/geometry/points/neighbour_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::geometry {
namespace {

using Pairs = std::set<std::pair<spectral::Index, spectral::Index>>;

Eigen::MatrixXd random_points(int dimension, int count, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd points(dimension, count);
  for (auto& value : points.reshaped()) value = random.uniform();
  return points;
}

Pairs pairs_of(const spectral::WeightedGraph& graph) {
  Pairs pairs;
  std::pair<spectral::Index, spectral::Index> last{-1, -1};
  for (const auto& edge : graph.edges()) {
    EXPECT_EQ(edge.weight, 1.0);
    EXPECT_LT(edge.from, edge.to);
    EXPECT_LT(last, std::pair(edge.from, edge.to));
    last = {edge.from, edge.to};
    pairs.insert(last);
  }
  return pairs;
}

Pairs nearest_by_hand(const Eigen::MatrixXd& points, int neighbours) {
  Pairs pairs;
  for (int i = 0; i < points.cols(); ++i) {
    std::vector<std::pair<double, int>> others;
    for (int j = 0; j < points.cols(); ++j) {
      if (j != i) others.emplace_back((points.col(i) - points.col(j)).squaredNorm(), j);
    }
    std::sort(others.begin(), others.end());
    for (int k = 0; k < std::min<int>(neighbours, static_cast<int>(others.size())); ++k) {
      pairs.insert(std::minmax(i, others[k].second));
    }
  }
  return pairs;
}

TEST(NeighbourGraph, NearestAgreeWithAllPairs) {
  for (const int dimension : {1, 2, 3, 6}) {
    const auto points = random_points(dimension, 150, 7);
    for (const int neighbours : {1, 4, 7}) {
      EXPECT_EQ(pairs_of(nearest_neighbour_graph(points, neighbours)),
                nearest_by_hand(points, neighbours));
    }
  }
}

TEST(NeighbourGraph, RadiusAgreesWithAllPairs) {
  for (const int dimension : {1, 2, 5}) {
    const auto points = random_points(dimension, 120, 8);
    Pairs expected;
    for (int i = 0; i < points.cols(); ++i) {
      for (int j = i + 1; j < points.cols(); ++j) {
        if ((points.col(i) - points.col(j)).norm() <= 0.3) expected.insert({i, j});
      }
    }
    EXPECT_EQ(pairs_of(radius_graph(points, 0.3)), expected);
  }
}

TEST(NeighbourGraph, TiesAndTheEndOfTheRadius) {
  Eigen::MatrixXd grid(2, 9);
  for (int k = 0; k < 9; ++k) grid.col(k) << k % 3, k / 3;
  EXPECT_EQ(radius_graph(grid, 1.0).edge_count(), 12);
  EXPECT_EQ(pairs_of(nearest_neighbour_graph(grid, 1)), nearest_by_hand(grid, 1));
}

TEST(NeighbourGraph, CoincidentPoints) {
  const Eigen::MatrixXd points = Eigen::MatrixXd::Constant(3, 40, 2.0);
  EXPECT_EQ(radius_graph(points, 1e-3).edge_count(), 40 * 39 / 2);
  const auto graph = nearest_neighbour_graph(points, 3);
  for (spectral::Index v = 0; v < 40; ++v) EXPECT_GE(graph.neighbours(v).size(), 3u);
}

TEST(NeighbourGraph, FewPoints) {
  EXPECT_EQ(nearest_neighbour_graph(Eigen::MatrixXd(2, 0), 3).vertex_count(), 0);
  EXPECT_EQ(nearest_neighbour_graph(random_points(2, 1, 1), 3).edge_count(), 0);
  EXPECT_EQ(nearest_neighbour_graph(random_points(2, 3, 1), 7).edge_count(), 3);
  EXPECT_EQ(radius_graph(random_points(2, 1, 1), 3.0).vertex_count(), 1);
}

TEST(NeighbourGraph, DoesNotDependOnTheNumberOfThreads) {
  const auto points = random_points(3, 500, 9);
  EXPECT_EQ(pairs_of(nearest_neighbour_graph(points, 6, {.threads = 1})),
            pairs_of(nearest_neighbour_graph(points, 6, {.threads = 3})));
}

TEST(NeighbourGraph, RefusesWhatItCannotJoin) {
  auto points = random_points(2, 5, 1);
  EXPECT_THROW(nearest_neighbour_graph(points, 0), InvalidArgument);
  EXPECT_THROW(radius_graph(points, 0.0), InvalidArgument);
  EXPECT_THROW(radius_graph(points, std::nan("")), InvalidArgument);
  EXPECT_THROW(radius_graph(points, 1.0, {.threads = -1}), InvalidArgument);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200}) {
    points(1, 2) = bad;
    EXPECT_THROW(nearest_neighbour_graph(points, 2), InvalidArgument);
    EXPECT_THROW(radius_graph(points, 1.0), InvalidArgument);
  }
  const auto stop = [](const Progress&) { return false; };
  EXPECT_THROW(radius_graph(random_points(2, 500, 1), 0.1, {.threads = 1, .progress = stop}),
               Cancelled);
}

}  // namespace
}  // namespace isotherm::geometry
