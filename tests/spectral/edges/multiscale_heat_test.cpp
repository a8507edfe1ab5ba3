#include "isotherm/spectral/edges/multiscale_heat.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/edges/judge_edges.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"
#include "isotherm/spectral/heat/heat_scales.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

Solver dense(const WeightedGraph& graph) {
  return Solver(Eigen::MatrixXd(Laplacian(graph).matrix()));
}

WeightedGraph grid_with_shortcuts() {
  const auto grid = grid_graph(12, 12);
  std::vector<WeightedEdge> edges(grid.edges().begin(), grid.edges().end());
  for (const auto& [from, to] : {std::pair<Index, Index>{0, 100}, {13, 77}, {5, 140}}) {
    edges.push_back({from, to, 0.2});
  }
  edges.push_back({143, 144, 1.0});  // a bridge
  return {145, std::move(edges)};
}

/// Algorithm 1 with a dense heat kernel: which edges are left.
std::vector<bool> oracle(const WeightedGraph& graph, std::vector<Index> candidates,
                         const std::vector<double>& scales, double konst) {
  std::vector<bool> keep(graph.edges().size(), true);
  for (const double t : scales) {
    const auto eigen = dense(filter_edges(graph, keep));
    std::vector<double> distances;
    for (const Index e : candidates) {
      const auto& edge = graph.edge(e);
      const Eigen::VectorXd step =
          (eigen.eigenvectors().row(edge.from) - eigen.eigenvectors().row(edge.to)).transpose();
      const Eigen::ArrayXd decay = (-t * eigen.eigenvalues().array()).exp();
      distances.push_back((step.array().square() * decay).sum());
    }
    const double n = static_cast<double>(distances.size());
    const double mean = std::accumulate(distances.begin(), distances.end(), 0.0) / n;
    double variance = 0.0;
    for (const double d : distances) variance += (d - mean) * (d - mean) / n;
    std::vector<Index> left;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const bool far = distances[k] > mean + konst * std::sqrt(variance);
      if (far) keep[candidates[k]] = false;
      if (!far) left.push_back(candidates[k]);
    }
    candidates = std::move(left);
  }
  return keep;
}

TEST(MultiscaleHeat, IsAlgorithm1OfADenseOracle) {
  const auto graph = grid_with_shortcuts();
  std::vector<Index> candidates(graph.edges().size() - 1);  // all but the bridge
  std::iota(candidates.begin(), candidates.end(), 0);
  const std::vector<double> scales = {50.0, 5.0, 0.5};
  for (const double konst : {1.0, 2.0, 3.0}) {
    const auto expected = oracle(graph, candidates, scales, konst);
    const auto found = multiscale_heat(graph, candidates,
                                       {.scales = scales, .konst = {konst}, .tolerance = 1e-12});
    const auto verdicts = judge_edges(graph, {.method = EdgeScore::heat_multiscale,
                                              .konst = {konst},
                                              .scales = scales,
                                              .tolerance = 1e-12})
                              .verdicts;
    for (std::size_t e = 0; e < candidates.size(); ++e) {
      EXPECT_EQ(found.verdicts[e].pruned, !expected[e]) << e << ' ' << konst;
      EXPECT_EQ(verdicts[e].verdict, expected[e] ? Verdict::keep : Verdict::prune);
    }
    EXPECT_EQ(verdicts.back().stage, "bridge");
  }
}

TEST(MultiscaleHeat, TrustedEdgesStayAndCountInNoThreshold) {
  const auto graph = grid_with_shortcuts();
  JudgeEdgesOptions options = {.method = EdgeScore::heat_multiscale, .konst = {0.5}};
  for (Index e = 0; e < grid_graph(12, 12).edge_count(); ++e) options.trusted.push_back(e);
  const auto verdicts = judge_edges(graph, options).verdicts;
  for (const Index e : options.trusted) EXPECT_EQ(verdicts[e].stage, "trusted");
  EXPECT_GT(count(verdicts, Verdict::prune), 0);
  EXPECT_EQ(count(verdicts, Verdict::keep) + count(verdicts, Verdict::prune),
            graph.edge_count() - 1);
  options.trusted = {graph.edge_count()};
  EXPECT_THROW(judge_edges(graph, options), InvalidArgument);
}

TEST(MultiscaleHeat, RejectsOptionsOutOfRange) {
  const auto graph = ring_graph(5);
  const std::vector<Index> edges = {0, 1};
  EXPECT_THROW(multiscale_heat(graph, edges, {.scales = {1.0, 2.0}}), InvalidArgument);
  EXPECT_THROW(multiscale_heat(graph, edges, {.scales = {-1.0}}), InvalidArgument);
  EXPECT_THROW(multiscale_heat(graph, edges, {.konst = {}}), InvalidArgument);
  EXPECT_THROW(multiscale_heat(graph, edges, {.konst = {1.0, 2.0}}), InvalidArgument);
  EXPECT_THROW(multiscale_heat(graph, edges, {.tolerance = 0.0}), InvalidArgument);
  EXPECT_THROW(multiscale_heat(graph, std::vector<Index>{5}), InvalidArgument);
}

TEST(AutomaticScales, AreThoseOfTheDenseSpectrum) {
  Random random(3);
  for (const auto& graph : {grid_graph(9, 7), loopy_path(200, 40, random), ring_graph(30)}) {
    const double lambda2 = dense(graph).eigenvalues()[1];
    const auto scales = automatic_scales(graph);
    ASSERT_EQ(scales.size(), 7u);
    EXPECT_NEAR(scales.front() * lambda2, 5.0, 1e-6);
    EXPECT_NEAR(scales.back(), 0.001, 1e-15);
  }
  EXPECT_EQ(automatic_scales(WeightedGraph(3, {})).front(), 1.0);
}

}  // namespace
}  // namespace isotherm::spectral
