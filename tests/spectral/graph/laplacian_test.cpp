#include "isotherm/spectral/graph/laplacian.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "spectral/graphs.hpp"

namespace isotherm::spectral {
namespace {

using isotherm_test::complete_graph;
using isotherm_test::disjoint_union;
using isotherm_test::path_graph;
using isotherm_test::random_geometric;

TEST(Laplacian, AddsParallelEdgesAndDropsSelfLoops) {
  const Laplacian laplacian(WeightedGraph(3, {{0, 1, 1.0}, {1, 0, 2.0}, {1, 1, 9.0}}));
  Eigen::Matrix3d expected;
  expected << 3, -3, 0, -3, 3, 0, 0, 0, 0;
  EXPECT_EQ(Eigen::Matrix3d(laplacian.matrix()), expected);
  EXPECT_EQ(laplacian.components().count, 2);
  EXPECT_EQ(laplacian.norm_bound(), 6.0);
}

TEST(Laplacian, EmptyGraph) {
  const Laplacian laplacian{WeightedGraph()};
  EXPECT_EQ(laplacian.size(), 0);
  EXPECT_EQ(laplacian.norm_bound(), 0.0);
  EXPECT_EQ(laplacian.null_space().cols(), 0);
}

TEST(Laplacian, NullSpaceIsAnnihilatedAndOrthonormal) {
  Random random(5);
  const auto graph = disjoint_union(random_geometric(40, 0.3, random), path_graph(7));
  for (const auto kind : {LaplacianKind::combinatorial, LaplacianKind::normalised}) {
    const Laplacian laplacian(graph, kind);
    const Eigen::MatrixXd basis(laplacian.null_space());
    ASSERT_EQ(basis.cols(), laplacian.components().count);
    EXPECT_LT((laplacian.matrix() * basis).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_TRUE((basis.transpose() * basis).isIdentity(1e-13));
  }
}

TEST(Laplacian, NormBoundHolds) {
  Random random(6);
  const auto graph = random_geometric(60, 0.25, random);
  for (const auto kind : {LaplacianKind::combinatorial, LaplacianKind::normalised}) {
    const Laplacian laplacian(graph, kind);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
        Eigen::MatrixXd(laplacian.matrix()));
    EXPECT_LE(solver.eigenvalues().maxCoeff(), laplacian.norm_bound() + 1e-12);
    EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12);
  }
}

TEST(Laplacian, NormalisedRowsOfIsolatedVerticesVanish) {
  const Laplacian laplacian(WeightedGraph(3, {{0, 2, 4.0}}), LaplacianKind::normalised);
  Eigen::Matrix3d expected;
  expected << 1, 0, -1, 0, 0, 0, -1, 0, 1;
  EXPECT_TRUE(Eigen::Matrix3d(laplacian.matrix()).isApprox(expected));
}

TEST(Laplacian, NormalisedCompleteGraph) {
  const Laplacian laplacian(complete_graph(5), LaplacianKind::normalised);
  const Eigen::MatrixXd dense(laplacian.matrix());
  EXPECT_NEAR(dense(0, 1), -0.25, 1e-15);
  EXPECT_EQ(dense(3, 3), 1.0);
}

}  // namespace
}  // namespace isotherm::spectral
