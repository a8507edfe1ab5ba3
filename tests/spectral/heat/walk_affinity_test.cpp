#include "heat/walk_affinity.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/error.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

/// D^-1/2 W D^-1/2 with one edge taken out of W but not of D.
Eigen::MatrixXd dense_matrix(const WeightedGraph& graph, const std::vector<double>& trust,
                             Index left_out) {
  const Index n = graph.vertex_count();
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd degrees = Eigen::VectorXd::Zero(n);
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto [from, to, weight] = graph.edge(e);
    if (from == to) continue;
    degrees[from] += trust[e] * weight;
    degrees[to] += trust[e] * weight;
    if (e == left_out) continue;
    weights(from, to) += trust[e] * weight;
    weights(to, from) += trust[e] * weight;
  }
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      if (weights(i, j) != 0.0) weights(i, j) /= std::sqrt(degrees[i] * degrees[j]);
    }
  }
  return weights;
}

double dense_affinity(const Eigen::MatrixXd& matrix, Index i, Index j, double scale, int horizon) {
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(matrix.rows(), matrix.rows());
  Eigen::MatrixXd heat = power;
  double weight = 1.0;
  for (int k = 1; k <= horizon; ++k) {
    power = power * matrix;
    weight *= scale / k;
    heat += weight * power;
  }
  return heat(i, j) / std::sqrt(heat(i, i) * heat(j, j));
}

void expect_dense_values(const WeightedGraph& graph, const std::vector<double>& trust,
                         const WalkAffinityOptions& options) {
  std::vector<VertexPair> pairs;
  for (Index v = 0; v < graph.vertex_count(); v += 3) {
    pairs.push_back({v, graph.vertex_count() - 1 - v});
  }
  const auto result = walk_affinities(graph, trust, pairs, options);
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto& edge = graph.edge(e);
    const double expected = dense_affinity(dense_matrix(graph, trust, e), edge.from, edge.to,
                                           options.scale, options.horizon);
    EXPECT_NEAR(result.edges[e], expected, 1e-11 + 1e-9 * expected) << e;
  }
  const auto matrix = dense_matrix(graph, trust, -1);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    EXPECT_NEAR(result.pairs[k],
                dense_affinity(matrix, pairs[k].from, pairs[k].to, options.scale, options.horizon),
                1e-12);
  }
}

TEST(WalkAffinity, AgreesWithDensePowers) {
  Random random(1);
  for (const int horizon : {1, 2, 3, 5, 9}) {
    const auto graph = spread_weights(random_geometric(60, 0.25, random), 2.0, random);
    std::vector<double> trust(graph.edges().size());
    for (double& value : trust) value = random.uniform() < 0.2 ? 0.0 : random.uniform();
    expect_dense_values(graph, trust, {.scale = 1.5, .horizon = horizon});
  }
}

TEST(WalkAffinity, ParallelEdgesAndSelfLoops) {
  const WeightedGraph graph(
      5, {{0, 1, 1.0}, {1, 0, 2.0}, {1, 2, 1.0}, {2, 2, 5.0}, {2, 0, 0.5}, {3, 4, 1.0}});
  const std::vector<double> trust(6, 1.0);
  expect_dense_values(graph, trust, {.scale = 1.0, .horizon = 6});
  const auto edges = walk_affinities(graph, trust, {}, {.scale = 1.0, .horizon = 6}).edges;
  EXPECT_EQ(edges[3], 1.0);  // a self-loop
  EXPECT_EQ(edges[5], 0.0);  // a bridge
}

TEST(WalkAffinity, WhatTheHorizonHidesIsAPoissonTail) {
  Random random(2);
  const auto graph = random_geometric(50, 0.3, random);
  const std::vector<double> trust(graph.edges().size(), 1.0);
  const auto matrix = dense_matrix(graph, trust, -1);
  const double scale = 2.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  const Eigen::MatrixXd exact = eigen.eigenvectors() *
                                (scale * eigen.eigenvalues()).array().exp().matrix().asDiagonal() *
                                eigen.eigenvectors().transpose();
  for (const int horizon : {4, 6, 8}) {
    Eigen::MatrixXd power = Eigen::MatrixXd::Identity(50, 50);
    Eigen::MatrixXd heat = power;
    double weight = 1.0, inside = 1.0;
    for (int k = 1; k <= horizon; ++k) {
      power = power * matrix;
      weight *= scale / k;
      heat += weight * power;
      inside += weight;
    }
    EXPECT_LE(((exact - heat) * std::exp(-scale)).cwiseAbs().maxCoeff(),
              1.0 - inside * std::exp(-scale) + 1e-12);
  }
}

TEST(WalkAffinity, ExtremeWeights) {
  const WeightedGraph graph(4, {{0, 1, 1e308},
                                {1, 2, 1e308},
                                {2, 0, 1e308},
                                {2, 3, 1e-300},
                                {3, 0, std::numeric_limits<double>::denorm_min()}});
  const std::vector<double> trust(5, 1.0);
  const auto result = walk_affinities(graph, trust, {}, {.scale = 1.0, .horizon = 5});
  for (const double value : result.edges) {
    EXPECT_GE(value, 0.0);
    EXPECT_LE(value, 1.0);
  }
  EXPECT_GT(result.edges[0], 0.1);
}

TEST(WalkAffinity, SameBytesWithAnyNumberOfThreads) {
  Random random(3);
  const auto graph = random_geometric(400, 0.1, random);
  const std::vector<double> trust(graph.edges().size(), 1.0);
  const auto one = walk_affinities(graph, trust, {}, {.horizon = 5, .threads = 1});
  const auto three = walk_affinities(graph, trust, {}, {.horizon = 5, .threads = 3});
  EXPECT_EQ(one.edges, three.edges);
}

TEST(WalkAffinity, HorizonsThatAreAffordable) {
  const auto path = path_graph(10'000);
  const std::vector<double> trust(path.edges().size(), 1.0);
  EXPECT_EQ(affordable_horizon(path, trust, 9, 1e9), 9);
  EXPECT_EQ(affordable_horizon(path, trust, 9, 1.0), 2);
  EXPECT_EQ(affordable_horizon(path, std::vector<double>(trust.size(), 0.0), 9, 1.0), 9);
  const auto star = star_graph(10'000);
  const std::vector<double> all(star.edges().size(), 1.0);
  EXPECT_EQ(affordable_horizon(star, all, 9, 1e6), 2);
  EXPECT_EQ(affordable_horizon(WeightedGraph(), {}, 9, 1.0), 9);
}

TEST(WalkAffinity, CanBeCancelled) {
  const auto graph = grid_graph(30, 30);
  const std::vector<double> trust(graph.edges().size(), 1.0);
  const auto stop = [](const Progress&) { return false; };
  EXPECT_THROW(walk_affinities(graph, trust, {}, {.threads = 1, .progress = stop}), Cancelled);
}

}  // namespace
}  // namespace isotherm::spectral::detail
