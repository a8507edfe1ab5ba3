#include "isotherm/spectral/heat/heat_distance.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "isotherm/base/error.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

const std::vector<double> kFigure5 = {100, 70, 10, 5, 1, 0.1, 0.001};
const HeatDistanceOptions kTight = {.tolerance = 1e-10};

/// Exact heat distances: a dense eigendecomposition in extended precision, so
/// that brackets can be checked to the last place.
class DenseOracle {
 public:
  explicit DenseOracle(const WeightedGraph& graph) {
    Matrix laplacian = Matrix::Zero(graph.vertex_count(), graph.vertex_count());
    for (const auto& edge : graph.edges()) {
      if (edge.from == edge.to) continue;
      laplacian(edge.from, edge.from) += edge.weight;
      laplacian(edge.to, edge.to) += edge.weight;
      laplacian(edge.from, edge.to) -= edge.weight;
      laplacian(edge.to, edge.from) -= edge.weight;
    }
    solver_.compute(laplacian);
  }

  double distance(VertexPair pair, double scale) const {
    const auto& vectors = solver_.eigenvectors();
    long double sum = 0.0L;
    for (Index k = 0; k < vectors.cols(); ++k) {
      const long double difference = vectors(pair.from, k) - vectors(pair.to, k);
      sum += std::exp(-static_cast<long double>(scale) * solver_.eigenvalues()[k]) * difference *
             difference;
    }
    return static_cast<double>(sum);
  }

 private:
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  Eigen::SelfAdjointEigenSolver<Matrix> solver_;
};

/// The bracket of every value holds the exact one and is no wider than the
/// tolerance. Returns the number of values.
std::size_t check_brackets(const WeightedGraph& graph, const DenseOracle& oracle,
                           std::span<const VertexPair> pairs, const HeatDistanceOptions& options) {
  const auto result = heat_distances(graph, pairs, kFigure5, options);
  // Lanczos alone may need more steps than it is allowed.
  EXPECT_TRUE(result.converged() || options.method == HeatMethod::lanczos) << result.widest;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    for (std::size_t s = 0; s < kFigure5.size(); ++s) {
      const auto& value = result.at(k, s);
      const double exact = oracle.distance(pairs[k], kFigure5[s]);
      EXPECT_LE(value.lower, exact) << enum_name(options.method) << " " << kFigure5[s];
      EXPECT_GE(value.upper, exact) << enum_name(options.method) << " " << kFigure5[s];
      EXPECT_LE(value.lower, value.value);
      EXPECT_LE(value.value, value.upper);
      if (result.converged()) {
        EXPECT_LE(value.width(), options.tolerance);
      }
    }
  }
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
  const auto result = heat_distances(graph, pairs, kFigure5, kTight);
  for (std::size_t s = 0; s < kFigure5.size(); ++s) {
    EXPECT_NEAR(result.at(0, s).value, 2.0 * std::exp(-6.0 * kFigure5[s]), 1e-10);
  }
  EXPECT_EQ(result.steps[0], 1);
}

TEST(HeatDistance, CompleteGraphInClosedForm) {
  const auto graph = complete_graph(9);
  const auto result = heat_distances(graph, edge_pairs(graph), std::vector{0.05}, kTight);
  for (const auto& value : result.values) {
    EXPECT_NEAR(value.value, 2.0 * std::exp(-9 * 0.05), 1e-10);
  }
}

TEST(HeatDistance, StarInClosedForm) {
  const auto graph = star_graph(12);
  const std::vector<VertexPair> leaves = {{3, 7}};
  const auto result = heat_distances(graph, leaves, std::vector{0.7}, kTight);
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

class HeatDistanceBrackets : public testing::TestWithParam<HeatMethod> {};

TEST_P(HeatDistanceBrackets, HoldTheExactValue) {
  Random random(7);
  std::size_t checked = 0;
  for (int round = 0; round < 3; ++round) {
    for (const auto& shape : {loopy_path(40, 8, random), grid_graph(7, 6), random_tree(40, random),
                              random_geometric(40, 0.3, random),
                              disjoint_union(loopy_path(20, 4, random), grid_graph(5, 4))}) {
      for (const double decades : {0.0, 8.0}) {
        const auto graph = spread_weights(shape, decades, random);
        const DenseOracle oracle(graph);
        for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
          const auto pairs = random_pairs(graph.vertex_count(), 20, random);
          checked +=
              check_brackets(graph, oracle, pairs, {.tolerance = tolerance, .method = GetParam()});
        }
      }
    }
  }
  EXPECT_GE(checked, 10000u);
}

INSTANTIATE_TEST_SUITE_P(Methods, HeatDistanceBrackets,
                         testing::Values(HeatMethod::automatic, HeatMethod::lanczos,
                                         HeatMethod::rational),
                         [](const auto& test) { return std::string(enum_name(test.param)); });

TEST(HeatDistance, TightTolerances) {
  Random random(17);
  const auto graph = loopy_path(60, 12, random);
  const DenseOracle oracle(graph);
  for (const auto method : {HeatMethod::lanczos, HeatMethod::rational}) {
    const HeatDistanceOptions options = {.tolerance = 2e-10, .method = method};
    check_brackets(graph, oracle, edge_pairs(graph), options);
    EXPECT_TRUE(heat_distances(graph, edge_pairs(graph), kFigure5, options).converged());
  }
}

TEST(HeatDistance, AutomaticChoiceStatesItsReasons) {
  const auto graph = grid_graph(60, 60);
  const std::vector<double> scales = {0.01, 1.0, 1e5};
  const auto result = heat_distances(graph, edge_pairs(graph), scales, {.tolerance = 1e-8});
  EXPECT_TRUE(result.converged());
  EXPECT_EQ(result.methods[0], HeatMethod::lanczos);
  EXPECT_EQ(result.methods[2], HeatMethod::rational);
  for (const auto& reason : result.reasons) EXPECT_NE(reason.find("estimated"), std::string::npos);
}

TEST(HeatDistance, PairsThatLanczosGivesUpGoToTheOtherMethod) {
  const auto graph = path_graph(120);
  const std::vector<VertexPair> pairs = {{50, 51}, {10, 110}};
  const std::vector<double> scales = {1000.0};
  const auto result = heat_distances(graph, pairs, scales, {.max_steps = 5});
  EXPECT_TRUE(result.converged());
  EXPECT_EQ(result.methods[1], HeatMethod::rational);
  const DenseOracle oracle(graph);
  EXPECT_NEAR(result.at(1, 0).value, oracle.distance(pairs[1], 1000.0), 1e-6);
}

TEST(HeatDistance, DegeneratePairsAndScales) {
  const auto graph = disjoint_union(path_graph(3), WeightedGraph(2, {}));
  const std::vector<VertexPair> pairs = {{1, 1}, {3, 4}, {0, 3}};
  const std::vector<double> scales = {0.0, 2.0};
  const auto result = heat_distances(graph, pairs, scales, kTight);
  EXPECT_EQ(result.at(0, 1).value, 0.0);
  EXPECT_EQ(result.methods[0], HeatMethod::exact);
  EXPECT_NEAR(result.at(1, 1).value, 2.0, 1e-10);
  EXPECT_NEAR(result.at(2, 0).value, 2.0, 1e-10);
  // H_33 = 1 for the isolated vertex; H_00 from the spectrum 0, 1, 3 of the path.
  const double corner = 1.0 / 3 + std::exp(-2.0) / 2 + std::exp(-6.0) / 6;
  EXPECT_NEAR(result.at(2, 1).value, 1.0 + corner, 1e-6);
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
  const HeatDistance engine(graph, {.tolerance = 1e-10, .method = HeatMethod::lanczos});
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
  const auto graph = path_graph(120);
  const std::vector<VertexPair> pairs = {{20, 100}};
  const auto result =
      heat_distances(graph, pairs, std::vector{1000.0},
                     {.tolerance = 1e-9, .method = HeatMethod::lanczos, .max_steps = 5});
  EXPECT_FALSE(result.converged());
  EXPECT_EQ(result.unconverged, 1);
  const double exact = DenseOracle(graph).distance(pairs[0], 1000.0);
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
