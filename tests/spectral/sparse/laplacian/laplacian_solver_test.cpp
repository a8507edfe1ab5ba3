#include "isotherm/spectral/sparse/laplacian_solver.hpp"

#include <gtest/gtest.h>
#include <Eigen/QR>

#include "isotherm/base/error.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

TEST(LaplacianSolver, IsThePseudoInverse) {
  Random random(31);
  const auto graph = disjoint_union(random_geometric(50, 0.25, random), loopy_path(30, 6, random));
  for (const auto kind : {LaplacianKind::combinatorial, LaplacianKind::normalised}) {
    const Laplacian laplacian(graph, kind);
    LaplacianSolver solver(laplacian);
    const Eigen::MatrixXd inverse =
        Eigen::MatrixXd(laplacian.matrix()).completeOrthogonalDecomposition().pseudoInverse();
    for (int round = 0; round < 5; ++round) {
      const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(
          laplacian.size(), [&](Eigen::Index) { return random.normal(); });
      EXPECT_TRUE(solver.solve(b).isApprox(inverse * b, 1e-9));
    }
  }
}

TEST(LaplacianSolver, GraphsWithoutEdges) {
  LaplacianSolver solver(Laplacian(WeightedGraph(3, {})));
  EXPECT_EQ(solver.solve(Eigen::Vector3d(1, 2, 3)), Eigen::Vector3d::Zero());
  EXPECT_EQ(LaplacianSolver(Laplacian(WeightedGraph())).solve(Eigen::VectorXd(0)).size(), 0);
}

TEST(LaplacianSolver, RejectsAWrongLength) {
  LaplacianSolver solver(Laplacian(path_graph(4)));
  EXPECT_THROW(solver.solve(Eigen::VectorXd::Zero(3)), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::spectral
