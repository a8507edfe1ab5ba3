#include "isotherm/spectral/heat_distance.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "graphs.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/spectral/laplacian.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

const std::vector<double> kFigure5 = {100, 70, 10, 5, 1, 0.1, 0.001};

/// exp(-tL) through a dense eigendecomposition.
Eigen::MatrixXd dense_kernel(const WeightedGraph& graph, double scale) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      Eigen::MatrixXd(Laplacian(graph).matrix()));
  const Eigen::VectorXd decay = (-scale * solver.eigenvalues().array()).exp();
  return solver.eigenvectors() * decay.asDiagonal() * solver.eigenvectors().transpose();
}

double dense_distance(const Eigen::MatrixXd& kernel, VertexPair pair) {
  return kernel(pair.from, pair.from) + kernel(pair.to, pair.to) - 2.0 * kernel(pair.from, pair.to);
}

/// Every value lies in its bracket, which is no wider than the tolerance, and
/// the bracket holds the dense value (which has rounding of its own).
std::size_t check_against_dense(const WeightedGraph& graph, std::span<const VertexPair> pairs,
                                const HeatDistanceOptions& options) {
  const auto result = heat_distances(graph, pairs, kFigure5, options);
  const double norm = Laplacian(graph).norm_bound();
  for (std::size_t s = 0; s < kFigure5.size(); ++s) {
    const auto kernel = dense_kernel(graph, kFigure5[s]);
    const double oracle_rounding = 1e-14 * (10.0 + 0.1 * norm * kFigure5[s]);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto& value = result.at(k, s);
      const double exact = dense_distance(kernel, pairs[k]);
      EXPECT_LE(value.lower, exact + oracle_rounding) << "scale " << kFigure5[s];
      EXPECT_GE(value.upper, exact - oracle_rounding) << "scale " << kFigure5[s];
      EXPECT_LE(value.lower, value.value);
      EXPECT_LE(value.value, value.upper);
      if (result.converged()) {
        EXPECT_LE(value.width(), options.tolerance);
      }
    }
  }
  EXPECT_TRUE(result.converged());
  return result.values.size();
}

std::vector<VertexPair> random_pairs(Index n, int count, Random& random) {
  std::vector<VertexPair> pairs;
  for (int k = 0; k < count; ++k) {
    pairs.push_back({random_vertex(random, n), random_vertex(random, n)});
  }
  return pairs;
}

TEST(HeatDistance, SingleEdgeInClosedForm) {
  const WeightedGraph graph(2, {{0, 1, 3.0}});
  const auto pairs = edge_pairs(graph);
  const auto result = heat_distances(graph, pairs, kFigure5);
  for (std::size_t s = 0; s < kFigure5.size(); ++s) {
    EXPECT_NEAR(result.at(0, s).value, 2.0 * std::exp(-6.0 * kFigure5[s]), 1e-10);
  }
  EXPECT_EQ(result.steps[0], 1);
}

TEST(HeatDistance, CompleteGraphInClosedForm) {
  const auto graph = complete_graph(9);
  const auto result = heat_distances(graph, edge_pairs(graph), std::vector{0.05});
  for (const auto& value : result.values) {
    EXPECT_NEAR(value.value, 2.0 * std::exp(-9 * 0.05), 1e-10);
  }
}

TEST(HeatDistance, StarInClosedForm) {
  const auto graph = star_graph(12);
  const std::vector<VertexPair> leaves = {{3, 7}};
  const auto result = heat_distances(graph, leaves, std::vector{0.7});
  EXPECT_NEAR(result.at(0, 0).value, 2.0 * std::exp(-0.7), 1e-10);
}

TEST(HeatDistance, RingInClosedForm) {
  const Index n = 31;
  const double scale = 4.0;
  double expected = 0.0;
  for (Index k = 0; k < n; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / n;
    expected +=
        std::exp(-scale * (2.0 - 2.0 * std::cos(angle))) * (2.0 - 2.0 * std::cos(5 * angle));
  }
  const std::vector<VertexPair> pairs = {{2, 7}, {30, 4}};
  const auto result = heat_distances(ring_graph(n), pairs, std::vector{scale});
  EXPECT_NEAR(result.at(0, 0).value, expected / n, 1e-6);
  EXPECT_NEAR(result.at(1, 0).value, expected / n, 1e-6);
}

TEST(HeatDistance, BracketsHoldTheDenseValue) {
  Random random(7);
  std::size_t checked = 0;
  for (int round = 0; round < 4; ++round) {
    for (const auto& graph : {loopy_path(70, 12, random), grid_graph(8, 7), random_tree(60, random),
                              random_geometric(60, 0.25, random),
                              disjoint_union(loopy_path(30, 5, random), grid_graph(5, 5))}) {
      for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
        const auto pairs = random_pairs(graph.vertex_count(), 25, random);
        checked += check_against_dense(graph, pairs, {.tolerance = tolerance});
      }
    }
  }
  EXPECT_GE(checked, 10000u);
}

TEST(HeatDistance, DegeneratePairsAndScales) {
  const auto graph = disjoint_union(path_graph(3), WeightedGraph(2, {}));
  const std::vector<VertexPair> pairs = {{1, 1}, {3, 4}, {0, 3}};
  const std::vector<double> scales = {0.0, 2.0};
  const auto result = heat_distances(graph, pairs, scales);
  EXPECT_EQ(result.at(0, 1).value, 0.0);
  EXPECT_EQ(result.methods[0], HeatMethod::exact);
  EXPECT_NEAR(result.at(1, 1).value, 2.0, 1e-10);
  EXPECT_NEAR(result.at(2, 0).value, 2.0, 1e-10);
  EXPECT_NEAR(result.at(2, 1).value, 1.0 + dense_kernel(graph, 2.0)(0, 0), 1e-6);
  EXPECT_TRUE(heat_distances(WeightedGraph(), {}, scales).values.empty());
  EXPECT_TRUE(heat_distances(graph, pairs, {}).values.empty());
}

TEST(HeatDistance, RelabellingChangesNothing) {
  Random random(8);
  const auto graph = loopy_path(300, 60, random);
  const auto permutation = random_permutation(300, random);
  const auto result = heat_distances(graph, edge_pairs(graph), kFigure5);
  const auto moved_graph = relabel(graph, permutation);
  const auto moved = heat_distances(moved_graph, edge_pairs(moved_graph), kFigure5);
  for (std::size_t k = 0; k < result.values.size(); ++k) {
    EXPECT_NEAR(result.values[k].value, moved.values[k].value, 1e-6);
  }
}

TEST(HeatDistance, ThreadCountDoesNotChangeAByte) {
  Random random(9);
  const auto graph = loopy_path(900, 100, random);
  const auto one = heat_distances(graph, edge_pairs(graph), kFigure5, {.threads = 1});
  const auto two = heat_distances(graph, edge_pairs(graph), kFigure5, {.threads = 2});
  EXPECT_EQ(
      std::memcmp(one.values.data(), two.values.data(), one.values.size() * sizeof(CertifiedValue)),
      0);
}

TEST(HeatDistance, StopsEarlyOnceAThresholdIsCleared) {
  Random random(10);
  const auto graph = loopy_path(1000, 60, random);
  const auto pairs = edge_pairs(graph);
  const HeatDistance engine(graph, {.tolerance = 1e-10});
  const std::vector<double> scales = {50.0};
  const std::vector<double> thresholds = {0.2};
  const auto full = engine.evaluate(pairs, scales);
  const auto early = engine.evaluate(pairs, scales, thresholds);
  EXPECT_TRUE(early.converged());
  std::int64_t full_steps = 0, early_steps = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    full_steps += full.steps[k];
    early_steps += early.steps[k];
    EXPECT_EQ(early.at(k, 0).lower > 0.2, full.at(k, 0).value > 0.2);
  }
  EXPECT_LT(2 * early_steps, full_steps);
}

TEST(HeatDistance, SaysWhenStepsRunOut) {
  const auto graph = path_graph(500);
  const std::vector<VertexPair> pairs = {{100, 400}};
  const auto result =
      heat_distances(graph, pairs, std::vector{1000.0},
                     {.tolerance = 1e-9, .method = HeatMethod::lanczos, .max_steps = 5});
  EXPECT_FALSE(result.converged());
  EXPECT_EQ(result.unconverged, 1);
  const double exact = dense_distance(dense_kernel(graph, 1000.0), pairs[0]);
  EXPECT_LE(result.at(0, 0).lower, exact);
  EXPECT_GE(result.at(0, 0).upper, exact);
}

TEST(HeatDistance, RejectsBadArguments) {
  const auto graph = path_graph(3);
  const std::vector<VertexPair> outside = {{0, 1}, {0, 3}};
  const std::vector<VertexPair> pair = {{0, 1}};
  EXPECT_THROW(heat_distances(graph, outside, kFigure5), InvalidArgument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(heat_distances(graph, pair, std::vector{-1.0}), InvalidArgument);
  EXPECT_THROW(heat_distances(graph, pair, std::vector{nan}), InvalidArgument);
  EXPECT_THROW(HeatDistance(graph, {.tolerance = 0.0}), InvalidArgument);
  EXPECT_THROW(HeatDistance(graph, {.tolerance = nan}), InvalidArgument);
  EXPECT_THROW(HeatDistance(graph, {.max_steps = 0}), InvalidArgument);
  EXPECT_THROW(HeatDistance(graph, {.threads = -1}), InvalidArgument);
  EXPECT_THROW(HeatDistance(graph).evaluate(pair, kFigure5, std::vector{1.0}), InvalidArgument);
}

TEST(HeatDistance, ProgressCanCancel) {
  Random random(11);
  const auto graph = loopy_path(500, 100, random);
  HeatDistanceOptions options;
  options.threads = 1;
  options.progress = [](const Progress&) { return false; };
  EXPECT_THROW(heat_distances(graph, edge_pairs(graph), kFigure5, options), Cancelled);
}

}  // namespace
}  // namespace isotherm::spectral
