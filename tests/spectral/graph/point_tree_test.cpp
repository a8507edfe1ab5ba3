#include "graph/point_tree.hpp"

#include <gtest/gtest.h>

#include "edges/pair_ranks.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::spectral::detail {
namespace {

Index count_by_hand(const Eigen::MatrixXd& points, Index point, Index other) {
  const auto squared = [&](Index v) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      sum += (points(i, v) - points(i, point)) * (points(i, v) - points(i, point));
    }
    return sum;
  };
  Index nearer = 0;
  for (Index v = 0; v < points.cols(); ++v) {
    if (v != point && squared(v) < squared(other)) ++nearer;
  }
  return nearer;
}

void expect_counts(const Eigen::MatrixXd& points, Random& random) {
  const PointTree tree(points);
  const auto n = static_cast<std::uint64_t>(points.cols());
  for (int k = 0; k < 300; ++k) {
    const auto point = static_cast<Index>(random.index(n));
    const auto other = static_cast<Index>(random.index(n));
    EXPECT_EQ(tree.count_nearer(point, other), count_by_hand(points, point, other));
  }
}

TEST(PointTree, CountsAsOneDoesByHand) {
  Random random(31);
  for (const int dimension : {1, 2, 3}) {
    Eigen::MatrixXd points(dimension, 700);
    for (double& x : points.reshaped()) x = random.normal(0.0, 10.0);
    expect_counts(points, random);
    // Many points equally far, many in the same place.
    expect_counts(points.array().round().matrix(), random);
  }
}

TEST(PointTree, HeapsAndSinglePoints) {
  const Eigen::MatrixXd heap = Eigen::MatrixXd::Constant(2, 1000, 0.3);
  EXPECT_EQ(PointTree(heap).count_nearer(1, 999), 0);
  Eigen::MatrixXd beside = heap;
  beside(0, 5) = 1.0;
  EXPECT_EQ(PointTree(beside).count_nearer(0, 5), 998);
  EXPECT_EQ(PointTree(beside).count_nearer(5, 0), 0);
  EXPECT_EQ(PointTree(heap.leftCols(1)).count_nearer(0, 0), 0);
}

TEST(PairRanks, OnALine) {
  // Unit steps: k - 1 vertices lie between, and as many as far on the other side, unless the line
  // ends there.
  Eigen::MatrixXd line(1, 100);
  for (Eigen::Index v = 0; v < 100; ++v) line(0, v) = static_cast<double>(v);
  const auto ranks =
      pair_ranks(line, {{50, 51}, {50, 55}, {0, 5}, {99, 94}, {7, 7}, {0, 99}}, 1, {});
  EXPECT_EQ(ranks, (std::vector<double>{0, 8, 4, 4, 0, 98}));
}

}  // namespace
}  // namespace isotherm::spectral::detail
