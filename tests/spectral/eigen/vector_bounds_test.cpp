#include "isotherm/spectral/eigen/vector_bounds.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "spectral/graphs.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;
using testing::ElementsAre;

/// Sine of the angle between a vector and the span of orthonormal columns.
double sine_to(const Eigen::VectorXd& vector, const Eigen::MatrixXd& space) {
  return (vector - space * (space.transpose() * vector)).norm();
}

/// Eigenvector k of a path of n vertices, in closed form.
Eigen::VectorXd wave(Index n, Index k) {
  Eigen::VectorXd values(n);
  for (Index v = 0; v < n; ++v) values[v] = std::cos(std::numbers::pi * k * (v + 0.5) / n);
  return values.normalized();
}

TEST(VectorBounds, HoldOnAPathWhoseVectorsAreKnown) {
  const Index n = 200;
  const Laplacian laplacian(path_graph(n));
  for (const auto method : {EigenMethod::dense, EigenMethod::shift_invert}) {
    const auto eigen = smallest_eigenpairs(laplacian, {.count = 12, .method = method});
    const auto bounds = vector_bounds(eigen, false);
    EXPECT_EQ(bounds.sines[0], 0.0);
    for (Index k = 1; k < 11; ++k) {
      EXPECT_EQ(bounds.group[static_cast<std::size_t>(k)], k);
      EXPECT_LT(bounds.sines[k], 1e-5);
      EXPECT_LE(sine_to(eigen.vectors.col(k), wave(n, k)), bounds.sines[k]) << enum_name(method);
    }
    EXPECT_EQ(bounds.sines[11], 1.0) << "nothing is known of what comes next";
  }
}

TEST(VectorBounds, HoldForVectorsThatAreDisturbed) {
  const Index n = 40;
  const Laplacian laplacian(path_graph(n));
  auto eigen = smallest_eigenpairs(laplacian, {.count = n, .method = EigenMethod::dense});
  const Eigen::MatrixXd matrix = laplacian.matrix();
  for (const double angle : {1e-8, 1e-5, 1e-3}) {
    auto turned = eigen;
    const Eigen::VectorXd a = eigen.vectors.col(5), b = eigen.vectors.col(30);
    turned.vectors.col(5) = std::cos(angle) * a + std::sin(angle) * b;
    turned.vectors.col(30) = std::cos(angle) * b - std::sin(angle) * a;
    for (const Index k : {5, 30}) {
      const Eigen::VectorXd u = turned.vectors.col(k);
      turned.values[k] = u.dot(matrix * u);
      turned.bounds[k] += (matrix * u - turned.values[k] * u).norm();
    }
    const auto bounds = vector_bounds(turned, true);
    EXPECT_GE(bounds.sines[5], std::sin(angle));
    EXPECT_GE(bounds.sines[30], std::sin(angle));
    EXPECT_LT(bounds.sines[10], angle + 1e-9) << "others are as they were";
  }
}

TEST(VectorBounds, EqualValuesAreAGroup) {
  const Index n = 30;
  const Laplacian laplacian(ring_graph(n));
  const auto eigen = smallest_eigenpairs(laplacian, {.count = 6});
  const auto bounds = vector_bounds(eigen, false);
  EXPECT_THAT(bounds.group, ElementsAre(0, 1, 1, 3, 3, 5));
  for (const Index k : {1, 2}) {
    Eigen::MatrixXd plane(n, 2);
    for (Index v = 0; v < n; ++v) {
      const double angle = 2.0 * std::numbers::pi * v / n;
      plane.row(v) << std::cos(angle), std::sin(angle);
    }
    plane *= std::sqrt(2.0 / n);
    EXPECT_LE(sine_to(eigen.vectors.col(k), plane), bounds.sines[k]);
    EXPECT_LT(bounds.sines[k], 1e-10);
  }
  EXPECT_EQ(bounds.sines[5], 1.0) << "its twin is not there";
}

TEST(VectorBounds, CompleteGraphsHaveOneGroup) {
  const Laplacian laplacian(complete_graph(8));
  const auto eigen = smallest_eigenpairs(laplacian, {.count = 8});
  const auto bounds = vector_bounds(eigen, true);
  EXPECT_THAT(bounds.group, ElementsAre(0, 1, 1, 1, 1, 1, 1, 1));
  EXPECT_LT(bounds.sines.maxCoeff(), 1e-10) << "no other value is near";
}

TEST(VectorBounds, DegenerateInput) {
  const Laplacian lone(WeightedGraph(1, {}));
  const auto one = vector_bounds(smallest_eigenpairs(lone, {.count = 1}), true);
  EXPECT_THAT(one.group, ElementsAre(0));
  EXPECT_EQ(one.sines[0], 0.0);
  // Two parts: two null vectors, which are exact.
  const Laplacian parts(WeightedGraph(4, {{0, 1, 1.0}, {2, 3, 2.0}}));
  const auto two = vector_bounds(smallest_eigenpairs(parts, {.count = 4}), true);
  EXPECT_THAT(two.group, ElementsAre(0, 0, 2, 3));
  EXPECT_EQ(two.sines[1], 0.0);
  EXPECT_LT(two.sines[3], 1e-12);
  // Weights over so many decades that values are not known.
  const Laplacian wide(WeightedGraph(3, {{0, 1, 1e-20}, {1, 2, 1.0}}));
  const auto eigen = smallest_eigenpairs(wide, {.count = 3});
  ASSERT_EQ(eigen.status, EigenStatus::not_converged);
  EXPECT_EQ(vector_bounds(eigen, true).sines[1], 1.0);
}

}  // namespace
}  // namespace isotherm::spectral
