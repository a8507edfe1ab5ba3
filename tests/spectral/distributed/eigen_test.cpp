#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/eigen/eigen_decomposition.hpp"
#include "spectral/distributed/ranks.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;
using distributed::EigenSolver;

const std::vector<LaplacianKind> kKinds = {LaplacianKind::combinatorial, LaplacianKind::normalised};

/// Values agree with those of the dense solver, and vectors have the residuals that are stated.
void check_pairs(const WeightedGraph& graph, LaplacianKind kind, Index count, EigenSolver solver,
                 double tolerance) {
  const Laplacian laplacian(graph, kind);
  const auto exact = smallest_eigenpairs(laplacian, {.count = count, .method = EigenMethod::dense});
  const auto mine = distribute(graph);
  const auto found = distributed::smallest_eigenpairs(
      mine, kind, {.count = count, .tolerance = tolerance}, {.eigen_solver = solver});
  EXPECT_EQ(found.status, EigenStatus::converged);
  EXPECT_EQ(found.null_count, exact.null_count);
  if (found.count() != exact.count()) {
    ADD_FAILURE() << found.count() << " pairs, not " << exact.count();
    return;
  }
  for (Index k = 0; k < count; ++k) {
    EXPECT_NEAR(found.values[k], exact.values[k], found.bounds[k] + exact.bounds[k] + 1e-15) << k;
  }
  EXPECT_LT(found.orthogonality, 1e-9);
  // Of a value that stands alone, the vector is known but for its sign, which is fixed.
  for (Index k = found.null_count; k + 1 < count; ++k) {
    const double gap = std::min(k > 0 ? exact.values[k] - exact.values[k - 1] : exact.values[k],
                                exact.values[k + 1] - exact.values[k]);
    if (gap < 1e-3 * exact.values[k]) continue;
    const double allowed = 1e-7 + 4.0 * found.bounds[k] / gap;
    const auto rows = exact.vectors.col(k).segment(mine.block_begin(), found.vectors.rows());
    if (found.vectors.rows() == 0) continue;
    EXPECT_LT((found.vectors.col(k) - rows).cwiseAbs().maxCoeff(), allowed) << k;
  }
}

TEST(DistributedEigen, ShiftInvertAgreesWithTheDenseSolver) {
  Random random(11);
  for (const auto& graph : joined_shapes(random)) {
    for (const auto kind : kKinds) {
      check_pairs(graph, kind, 9, EigenSolver::shift_invert, 1e-10);
    }
    const auto spread = spread_weights(graph, 8.0, random);
    check_pairs(spread, LaplacianKind::combinatorial, 9, EigenSolver::shift_invert, 1e-10);
  }
}

TEST(DistributedEigen, LobpcgAgreesWithTheDenseSolver) {
  Random random(12);
  for (const auto& graph : joined_shapes(random)) {
    for (const auto kind : kKinds) check_pairs(graph, kind, 8, EigenSolver::lobpcg, 1e-8);
  }
}

TEST(DistributedEigen, FindsEveryCopyOfARepeatedValue) {
  for (const auto& graph : {grid_graph(6, 6), disjoint_union(ring_graph(30), ring_graph(30))}) {
    check_pairs(graph, LaplacianKind::combinatorial, 9, EigenSolver::shift_invert, 1e-10);
  }
  const auto found =
      distributed::smallest_eigenpairs(distribute(ring_graph(60)), LaplacianKind::combinatorial,
                                       {.count = 12}, {.eigen_solver = EigenSolver::shift_invert});
  EXPECT_EQ(found.inertia_count, 11);  // the last value is the first of two
}

TEST(DistributedEigen, NullVectorsTellComponentsApart) {
  const auto graph =
      disjoint_union(disjoint_union(path_graph(4), WeightedGraph(1, {})), path_graph(5));
  for (const auto kind : kKinds) {
    check_pairs(graph, kind, 3, EigenSolver::shift_invert, 1e-10);
    const auto exact = Laplacian(graph, kind).null_space().toDense();
    const auto mine = distribute(graph);
    const auto found = distributed::smallest_eigenpairs(mine, kind, {.count = 3});
    const auto rows = found.vectors.rows();
    EXPECT_TRUE(found.vectors.isApprox(exact.eval().middleRows(mine.block_begin(), rows)) ||
                rows == 0);
  }
}

TEST(DistributedEigen, SmallAndEmptyGraphs) {
  for (const auto& graph : {path_graph(2), path_graph(3), complete_graph(5)}) {
    const auto found = distributed::smallest_eigenpairs(
        distribute(graph), LaplacianKind::combinatorial, {.count = 10});
    EXPECT_EQ(found.count(), graph.vertex_count());
    EXPECT_EQ(found.status, EigenStatus::converged);
  }
  const auto alone = distributed::smallest_eigenpairs(distribute(WeightedGraph(3, {})),
                                                      LaplacianKind::combinatorial, {.count = 5});
  EXPECT_EQ(alone.count(), 3);
  const auto nothing = distributed::smallest_eigenpairs(distribute(WeightedGraph()),
                                                        LaplacianKind::combinatorial, {.count = 5});
  EXPECT_EQ(nothing.count(), 0);
}

TEST(DistributedEigen, EmbeddingsAgreeWithOneMachine) {
  Random random(13);
  const auto graph = loopy_path(200, 15, random);
  const auto mine = distribute(graph);
  for (const auto method : {Embedding::commute_time, Embedding::heat}) {
    const EmbedOptions options{.method = method, .dimensions = 3, .scale = 20.0};
    const auto exact = embed(graph, options);
    const auto found = distributed::embed(mine, options);
    EXPECT_EQ(found.solver, EigenSolver::shift_invert);
    EXPECT_EQ(found.components, exact.components);
    const auto rows = exact.rows.middleRows(mine.block_begin(), found.rows.rows());
    EXPECT_LT((found.rows - rows).cwiseAbs().maxCoeff(), 1e-6 * exact.rows.cwiseAbs().maxCoeff());
  }
}

TEST(DistributedEigen, TakesNoFactorThatDoesNotFit) {
  const auto graph = distribute(grid_graph(40, 40));
  const auto found = distributed::embed(graph, {.dimensions = 1}, {.factor_memory = 1e-9});
  EXPECT_EQ(found.solver, EigenSolver::lobpcg);
  EXPECT_EQ(found.eigen.inertia_count, -1);
}

TEST(DistributedEigen, EndsOnAllRanksWhereOneIsToEnd) {
  const auto graph = distribute(grid_graph(20, 20));
  for (const auto solver : {EigenSolver::shift_invert, EigenSolver::lobpcg}) {
    const int last = session().size() - 1;
    const auto stop = [last](const Progress& progress) {
      return session().rank() != last || progress.done < 3;
    };
    EXPECT_THROW(distributed::embed(graph, {}, {.eigen_solver = solver}, stop), Cancelled);
  }
}

}  // namespace
}  // namespace isotherm::spectral
