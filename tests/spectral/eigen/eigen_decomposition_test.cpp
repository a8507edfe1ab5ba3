#include "isotherm/spectral/eigen/eigen_decomposition.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/eigen/embedding.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

constexpr std::array kMethods = {EigenMethod::dense, EigenMethod::shift_invert};

double squared_sine(double angle) { return std::pow(std::sin(angle), 2); }

/// Good residuals and orthogonality, and nothing missed.
EigenDecomposition solve(const WeightedGraph& graph, Index count, EigenMethod method,
                         LaplacianKind kind = LaplacianKind::combinatorial) {
  const Laplacian laplacian(graph, kind);
  auto eigen = smallest_eigenpairs(laplacian, {.count = count, .method = method});
  EXPECT_EQ(eigen.status, EigenStatus::converged) << enum_name(method);
  EXPECT_EQ(eigen.null_count, std::min(count, laplacian.components().count));
  EXPECT_LE(eigen.residuals.maxCoeff(), 1e-10 * eigen.norm);
  EXPECT_LE(eigen.orthogonality, 1e-9);
  return eigen;
}

TEST(EigenDecomposition, PathInClosedForm) {
  const Index n = 60;
  for (const auto method : kMethods) {
    const auto eigen = solve(path_graph(n), 12, method);
    for (Index k = 0; k < 12; ++k) {
      EXPECT_NEAR(eigen.values[k], 4.0 * squared_sine(0.5 * std::numbers::pi * k / n), 1e-11);
    }
  }
}

TEST(EigenDecomposition, RingHasDoubleEigenvalues) {
  const Index n = 90;
  for (const auto method : kMethods) {
    const auto eigen = solve(ring_graph(n), 14, method);
    for (Index k = 0; k < 14; ++k) {
      const Index wave = (k + 1) / 2;
      EXPECT_NEAR(eigen.values[k], 4.0 * squared_sine(std::numbers::pi * wave / n), 1e-11);
    }
  }
}

TEST(EigenDecomposition, StarHasAnEigenvalueOfMultiplicityNearlyN) {
  for (const auto method : kMethods) {
    const auto eigen = solve(star_graph(50), 15, method);
    for (Index k = 1; k < 15; ++k) EXPECT_NEAR(eigen.values[k], 1.0, 1e-11);
  }
  const auto all = solve(star_graph(50), 50, EigenMethod::automatic);
  EXPECT_NEAR(all.values[49], 50.0, 1e-10);
}

TEST(EigenDecomposition, CompleteGraphInClosedForm) {
  for (const auto method : kMethods) {
    const auto eigen = solve(complete_graph(30), 9, method);
    for (Index k = 1; k < 9; ++k) EXPECT_NEAR(eigen.values[k], 30.0, 1e-10);
  }
}

TEST(EigenDecomposition, GridHasSumsOfPathEigenvalues) {
  const Index side = 30;
  std::vector<double> expected;
  for (Index i = 0; i < side; ++i) {
    for (Index j = 0; j < side; ++j) {
      expected.push_back(4.0 * squared_sine(0.5 * std::numbers::pi * i / side) +
                         4.0 * squared_sine(0.5 * std::numbers::pi * j / side));
    }
  }
  std::sort(expected.begin(), expected.end());
  const auto eigen = solve(grid_graph(side, side), 40, EigenMethod::shift_invert);
  for (Index k = 0; k < 40; ++k) EXPECT_NEAR(eigen.values[k], expected[k], 1e-11);
  EXPECT_GE(eigen.inertia_count, 0);
}

TEST(EigenDecomposition, CopiesOfAGraphMultiplyItsSpectrum) {
  auto graph = path_graph(40);
  for (int copy = 1; copy < 6; ++copy) graph = disjoint_union(graph, path_graph(40));
  const auto eigen = solve(graph, 24, EigenMethod::shift_invert);
  for (Index k = 0; k < 24; ++k) {
    EXPECT_NEAR(eigen.values[k], 4.0 * squared_sine(0.5 * std::numbers::pi * (k / 6) / 40), 1e-11);
  }
}

TEST(EigenDecomposition, FindsCopiesWithoutACountToo) {
  for (const Index side : {6, 12}) {
    for (const auto& part : {grid_graph(side, 6), complete_graph(side)}) {
      auto graph = part;
      for (int copy = 1; copy < 12; ++copy) graph = disjoint_union(graph, part);
      const Laplacian laplacian(graph);
      const auto dense =
          smallest_eigenpairs(laplacian, {.count = 24, .method = EigenMethod::dense});
      const auto found = smallest_eigenpairs(
          laplacian, {.count = 24, .method = EigenMethod::shift_invert, .check_inertia = false});
      EXPECT_EQ(found.status, EigenStatus::converged);
      ASSERT_EQ(found.count(), 24);
      for (Index k = 0; k < 24; ++k) EXPECT_NEAR(found.values[k], dense.values[k], 1e-10);
    }
  }
}

TEST(EigenDecomposition, ManyComponentsNeedNoNullVectors) {
  std::vector<WeightedEdge> edges;
  for (Index v = 0; v < 40000; v += 4) {
    edges.push_back({v, v + 1, 1.0});
    edges.push_back({v + 2, v + 3, v == 0 ? 0.5 : 2.0});
  }
  const Laplacian laplacian(WeightedGraph(40000, edges));
  const auto eigen = smallest_eigenpairs(laplacian, {.count = 6, .null_vectors = false});
  EXPECT_EQ(eigen.status, EigenStatus::converged);
  EXPECT_EQ(eigen.method, EigenMethod::shift_invert);
  EXPECT_EQ(eigen.null_count, 0);
  ASSERT_EQ(eigen.count(), 6);
  for (Index k = 0; k < 6; ++k) EXPECT_NEAR(eigen.values[k], k == 0 ? 1.0 : 2.0, 1e-11);
  EXPECT_LE(eigen.orthogonality, 1e-9);
  // All that are not null; none is left for the rest of the count.
  const Laplacian small(disjoint_union(path_graph(3), path_graph(2)));
  const auto all = smallest_eigenpairs(small, {.count = 9, .null_vectors = false});
  ASSERT_EQ(all.count(), 3);
  EXPECT_NEAR(all.values[0], 1.0, 1e-14);
  EXPECT_NEAR(all.values[2], 3.0, 1e-14);
}

TEST(EigenDecomposition, MethodsAgreeOnWeightedGraphs) {
  Random random(21);
  for (const auto kind : {LaplacianKind::combinatorial, LaplacianKind::normalised}) {
    for (const double decades : {0.0, 6.0}) {
      const auto graph = spread_weights(
          disjoint_union(loopy_path(150, 30, random), random_geometric(90, 0.2, random)), decades,
          random);
      const Laplacian laplacian(graph, kind);
      const auto count = laplacian.components().count + 10;
      const auto dense = solve(graph, count, EigenMethod::dense, kind);
      const auto sparse = solve(graph, count, EigenMethod::shift_invert, kind);
      for (Index k = 0; k < count; ++k) {
        EXPECT_NEAR(dense.values[k], sparse.values[k], 1e-12 * dense.norm);
      }
    }
  }
}

TEST(EigenDecomposition, NormalisedCompleteGraph) {
  for (const auto method : kMethods) {
    const auto eigen = solve(complete_graph(20), 5, method, LaplacianKind::normalised);
    for (Index k = 1; k < 5; ++k) EXPECT_NEAR(eigen.values[k], 20.0 / 19.0, 1e-11);
  }
}

TEST(EigenDecomposition, LongPathKeepsItsSmallestEigenvalues) {
  const Index n = 200000;
  const auto eigen = solve(path_graph(n), 5, EigenMethod::automatic);
  EXPECT_EQ(eigen.method, EigenMethod::shift_invert);
  for (Index k = 1; k < 5; ++k) {
    const double exact = 4.0 * squared_sine(0.5 * std::numbers::pi * k / n);
    EXPECT_NEAR(eigen.values[k] / exact, 1.0, 1e-4);
  }
}

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// Eigenvalues of the combinatorial Laplacian with eleven more bits, ascending.
LongMatrix eigenvalues_in_long_double(const WeightedGraph& graph) {
  LongMatrix matrix = LongMatrix::Zero(graph.vertex_count(), graph.vertex_count());
  for (const auto& [from, to, weight] : graph.edges()) {
    matrix(from, from) += weight;
    matrix(to, to) += weight;
    matrix(from, to) -= weight;
    matrix(to, from) -= weight;
  }
  return Eigen::SelfAdjointEigenSolver<LongMatrix>(matrix).eigenvalues();
}

TEST(EigenDecomposition, SixteenDecadesOfWeightsAreRightToTheirBoundsOrFlagged) {
  Random random(23);
  int converged = 0, runs = 0;
  for (int k = 0; k < 40; ++k) {
    const auto graph = k % 2 == 0 ? grid_graph(8, 8) : loopy_path(70, 14, random);
    const auto spread = spread_weights(graph, 16.0, random);
    const auto exact = eigenvalues_in_long_double(spread);
    for (const auto method : kMethods) {
      const auto eigen = smallest_eigenpairs(Laplacian(spread), {.count = 8, .method = method});
      ASSERT_EQ(eigen.count(), 8);
      for (Index pair = 1; pair < 8; ++pair) {
        const double value = eigen.values[pair];
        EXPECT_GE(value, 0.0);
        EXPECT_LE(std::abs(value - static_cast<double>(exact(pair))), eigen.bounds[pair]);
        if (eigen.status == EigenStatus::converged) {
          EXPECT_GT(value, eigen.bounds[pair]);
        }
      }
      EXPECT_TRUE(commute_time_embedding(eigen).allFinite());
      converged += eigen.status == EigenStatus::converged ? 1 : 0;
      ++runs;
    }
  }
  EXPECT_GT(converged, 0);
  EXPECT_LT(converged, runs);
}

TEST(EigenDecomposition, BipartiteGraphsAndCubesMissNoCopies) {
  std::vector<WeightedEdge> edges;
  for (Index v = 0; v < 256; ++v) {
    for (Index bit = 1; bit < 256; bit *= 2) {
      if ((v & bit) == 0) edges.push_back({v, v | bit, 1.0});
    }
  }
  // Of the cube of d dimensions 2 k is d-choose-k-fold.
  const auto cube = solve(WeightedGraph(256, edges), 40, EigenMethod::shift_invert);
  for (Index k = 0; k < 40; ++k) {
    EXPECT_NEAR(cube.values[k], k == 0 ? 0.0 : (k <= 8 ? 2.0 : (k <= 36 ? 4.0 : 6.0)), 1e-11);
  }
  edges.clear();
  for (Index v = 0; v < 60; ++v) {
    for (Index other = 60; other < 100; ++other) edges.push_back({v, other, 1.0});
  }
  const auto bipartite = solve(WeightedGraph(100, edges), 30, EigenMethod::shift_invert);
  for (Index k = 1; k < 30; ++k) EXPECT_NEAR(bipartite.values[k], 40.0, 1e-10);
}

TEST(EigenDecomposition, SignsAreFixed) {
  Random random(22);
  const auto eigen = solve(random_geometric(80, 0.3, random), 10, EigenMethod::dense);
  for (Index k = 0; k < 10; ++k) {
    Index largest = 0;
    eigen.vectors.col(k).cwiseAbs().maxCoeff(&largest);
    EXPECT_GT(eigen.vectors(largest, k), 0.0);
  }
}

TEST(EigenDecomposition, SmallAndEmptyGraphs) {
  EXPECT_EQ(smallest_eigenpairs(Laplacian{WeightedGraph()}).count(), 0);
  const auto one = smallest_eigenpairs(Laplacian{WeightedGraph(1, {})});
  ASSERT_EQ(one.count(), 1);
  EXPECT_EQ(one.values[0], 0.0);
  EXPECT_EQ(one.vectors(0, 0), 1.0);
  const auto isolated = solve(WeightedGraph(9, {}), 4, EigenMethod::shift_invert);
  EXPECT_EQ(isolated.null_count, 4);
  const auto edge = solve(path_graph(2), 5, EigenMethod::shift_invert);
  ASSERT_EQ(edge.count(), 2);
  EXPECT_NEAR(edge.values[1], 2.0, 1e-14);
}

TEST(EigenDecomposition, RejectsBadOptionsAndCanBeCancelled) {
  const Laplacian laplacian(path_graph(900));
  EXPECT_THROW(smallest_eigenpairs(laplacian, {.count = 0}), InvalidArgument);
  EXPECT_THROW(smallest_eigenpairs(laplacian, {.tolerance = 0.0}), InvalidArgument);
  EXPECT_THROW(smallest_eigenpairs(laplacian, {.max_restarts = 0}), InvalidArgument);
  EigenOptions options;
  options.progress = [](const Progress&) { return false; };
  EXPECT_THROW(smallest_eigenpairs(laplacian, options), Cancelled);
}

TEST(EigenDecomposition, NormalisedWeightsOverSixteenDecadesAreFlaggedNotRefused) {
  for (const int seed : {1, 2, 3, 4, 5}) {
    Random random(seed);
    const auto graph = spread_weights(loopy_path(700, 700, random), 16.0, random);
    const auto eigen = smallest_eigenpairs(Laplacian(graph, LaplacianKind::normalised),
                                           {.count = 5, .null_vectors = false});
    EXPECT_TRUE(eigen.vectors.allFinite()) << seed;
    if (eigen.status == EigenStatus::converged) {
      EXPECT_GT(eigen.values.minCoeff(), 0.0) << seed;
    }
  }
}

}  // namespace
}  // namespace isotherm::spectral
