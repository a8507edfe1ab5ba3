#include "isotherm/slam/prune/heat_prune.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/evaluate/evaluate_loops.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/slam/simulate/simulate.hpp"
#include "isotherm_test/data.hpp"
#include "isotherm_test/random_graphs.hpp"

namespace isotherm::slam {
namespace {

using spectral::Verdict;

// exp(-tL) of an induced graph by a dense eigendecomposition written here, so that
// nothing of the library's spectral code is trusted.
class DenseHeat {
 public:
  explicit DenseHeat(const spectral::WeightedGraph& graph) {
    Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(graph.vertex_count(), graph.vertex_count());
    for (const auto& edge : graph.edges()) {
      laplacian(edge.from, edge.from) += edge.weight;
      laplacian(edge.to, edge.to) += edge.weight;
      laplacian(edge.from, edge.to) -= edge.weight;
      laplacian(edge.to, edge.from) -= edge.weight;
    }
    eigen_.compute(laplacian);
  }

  double distance(Index i, Index j, double t) const {
    const Eigen::VectorXd difference =
        (eigen_.eigenvectors().row(i) - eigen_.eigenvectors().row(j)).transpose();
    return (difference.array().square() * (-t * eigen_.eigenvalues().array()).exp()).sum();
  }

  double eigenvalue(Index k) const { return eigen_.eigenvalues()[k]; }

 private:
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen_;
};

// Every distance that Algorithm 1 compares, against the dense value on the graph
// that is left at that scale.
template <class Pose>
void expect_dense_distances(const PoseGraph<Pose>& graph, HeatPruneOptions options,
                            double allowed) {
  options.tolerance = allowed;
  const auto roles = edge_roles(graph);
  const auto result = heat_prune(graph, roles, options);
  if (!options.scales.empty()) {
    ASSERT_EQ(result.rounds.size(), options.scales.size());
  }
  const auto induced = induce(graph, roles, options.induction);
  std::int64_t compared = 0;
  double worst = 0.0;
  std::vector<bool> keep(induced.graph.edges().size(), true);
  std::optional<DenseHeat> dense;
  for (std::size_t s = 0; s < result.rounds.size(); ++s) {
    if (s == 0 || result.rounds[s - 1].pruned > 0) {
      dense.emplace(spectral::filter_edges(induced.graph, keep));
    }
    for (std::size_t c = 0; c < roles.candidates.size(); ++c) {
      const double value = result.distances[s][c];
      if (std::isnan(value)) continue;
      const auto& edge = graph.constraints[roles.candidates[c]];
      const double expected = dense->distance(edge.from, edge.to, result.rounds[s].scale);
      worst = std::max(worst, std::abs(value - expected));
      ++compared;
      const std::string stage = result.verdicts[c].stage;
      if (value > result.rounds[s].threshold) {
        EXPECT_EQ(result.verdicts[c].verdict, Verdict::prune);
        keep[induced.constraint_edge[roles.candidates[c]]] = false;
      }
    }
  }
  EXPECT_LE(worst, allowed);
  EXPECT_GE(compared, static_cast<std::int64_t>(roles.candidates.size()));
}

Corrupted<Pose2> corrupted_city() {
  const auto city = simulate_city({.poses = 300, .measurements = {.loops = 120}, .seed = 2});
  return corrupt(city.graph, city.truth, {.count = 60, .seed = 2});
}

TEST(HeatPrune, DistancesAreThoseOfADenseOracleAtEveryScale) {
  const auto graph = corrupted_city().graph;
  expect_dense_distances(graph, {}, 1e-8);
  expect_dense_distances(graph, datta2016(), 1e-8);
}

TEST(HeatPrune, DistancesOnIntelAreThoseOfADenseOracle) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "posegraph2d/intel/intel.g2o");
  const auto file = read_pose_graph(path.string());
  auto options = datta2016();
  options.konst = {1000.0};  // nothing is pruned: one oracle serves all scales
  expect_dense_distances(std::get<PoseGraph<Pose2>>(file.graph), options, 1e-8);
}

TEST(HeatPrune, DistancesOnKitti06AreThoseOfADenseOracle) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "paper/kitti/kitti_06.g2o");
  const auto file = read_pose_graph(path.string());
  auto options = datta2016();
  options.konst = {1000.0};
  expect_dense_distances(std::get<PoseGraph<Pose2>>(file.graph), options, 1e-8);
}

TEST(HeatPrune, FollowsAlgorithm1) {
  const auto corrupted = corrupted_city();
  const auto roles = edge_roles(corrupted.graph);
  const auto result = heat_prune(corrupted.graph, roles, datta2016());
  std::int64_t left = static_cast<std::int64_t>(roles.candidates.size());
  for (std::size_t s = 0; s < result.rounds.size(); ++s) {
    const auto& round = result.rounds[s];
    EXPECT_EQ(round.candidates, left);
    double sum = 0.0;
    double squares = 0.0;
    for (const double d : result.distances[s]) {
      if (std::isnan(d)) continue;
      sum += d;
      squares += d * d;
    }
    const auto n = static_cast<double>(round.candidates);
    const double mean = sum / n;
    EXPECT_NEAR(round.threshold, mean + std::sqrt(squares / n - mean * mean), 1e-9) << "eq. 11";
    left -= round.pruned;
  }
  EXPECT_EQ(left, count(result.verdicts, Verdict::keep));
}

TEST(HeatPrune, PaperScalesSpanTheSpectrumOfTheInducedGraph) {
  const auto graph = corrupted_city().graph;
  const auto roles = edge_roles(graph);
  const auto options = datta2016();
  const auto induced = induce(graph, roles, options.induction);
  for (const Index c : roles.candidates) {
    const Index edge = induced.constraint_edge[c];
    EXPECT_LT(induced.graph.edge(edge).weight, options.induction.odometry_weight);
  }
  const double lambda2 = DenseHeat(induced.graph).eigenvalue(1);
  const auto rounds = heat_prune(graph, roles, options).rounds;
  ASSERT_EQ(rounds.size(), 7u);
  EXPECT_NEAR(rounds.front().scale, 5.0 / lambda2, 1e-6 / lambda2);
  EXPECT_NEAR(rounds.back().scale, 0.001, 1e-12);
  for (std::size_t s = 2; s < rounds.size(); ++s) {
    EXPECT_NEAR(rounds[s].scale / rounds[s - 1].scale, rounds[1].scale / rounds[0].scale, 1e-12);
  }
}

TEST(HeatPrune, ScaleZeroPrunesNothing) {
  const auto graph = corrupted_city().graph;
  auto options = datta2016();
  options.scales = {1.0, 0.0};
  const auto rounds = heat_prune(graph, edge_roles(graph), options).rounds;
  EXPECT_GT(rounds[0].pruned, 0);
  EXPECT_EQ(rounds[1].pruned, 0);
}

TEST(HeatPrune, SeparatesFalseLoopsAndScoresRank) {
  const auto corrupted = corrupted_city();
  const auto result = heat_prune(corrupted.graph, edge_roles(corrupted.graph));
  const auto metrics = evaluate_loops(result.verdicts, corrupted.labels);
  EXPECT_GE(metrics.precision(), 0.95);
  EXPECT_GE(metrics.recall(), 0.95);
  EXPECT_GT(metrics.auc, 0.99);
  for (const auto& verdict : result.verdicts) {
    EXPECT_EQ(verdict.verdict == Verdict::prune, verdict.score > verdict.threshold);
    EXPECT_EQ(verdict.stage.substr(0, 2), "t=");
  }
}

TEST(HeatPrune, AnUncorruptedGraphKeepsNearlyEverything) {
  const auto city = simulate_city({.poses = 400, .measurements = {.loops = 200}, .seed = 3});
  const auto result = heat_prune(city.graph, edge_roles(city.graph));
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
}

TEST(HeatPrune, WorksInSpaceOnDisconnectedAndEmptyGraphs) {
  Random random(4);
  auto graph = isotherm_test::random_chain<Pose3>(random, 60);
  Constraint<Pose3> loop;
  loop.from = 3;
  loop.to = 50;
  graph.constraints.push_back(loop);
  graph.constraints.push_back(loop);
  graph.constraints.erase(graph.constraints.begin() + 30);
  const auto result = heat_prune(graph, edge_roles(graph));
  ASSERT_EQ(result.verdicts.size(), 2u);
  EXPECT_EQ(result.verdicts[0].score, result.verdicts[1].score) << "parallel edges are alike";

  EXPECT_TRUE(heat_prune(PoseGraph<Pose2>(), EdgeRoles()).verdicts.empty());
}

TEST(HeatPrune, RejectsOptionsOutOfRange) {
  const auto bad = [](auto change) {
    HeatPruneOptions options;
    change(options);
    EXPECT_THROW(options.validate(), InvalidArgument);
  };
  bad([](auto& o) { o.konst = {}; });
  bad([](auto& o) { o.scales = {1.0, 2.0}; });
  bad([](auto& o) { o.scales = {1.0, -1.0}; });
  bad([](auto& o) { o.konst = {1.0, 2.0}; });
  bad([](auto& o) { o.konst = {std::nan("")}; });
  bad([](auto& o) { o.tolerance = 0.0; });
  bad([](auto& o) { o.min_separation = 2.0; });
}

TEST(HeatPrune, StopsWhenAsked) {
  const auto graph = corrupted_city().graph;
  const auto stop = [](const Progress&) { return false; };
  EXPECT_THROW(heat_prune(graph, edge_roles(graph), {}, {.progress = stop}), Cancelled);
}

}  // namespace
}  // namespace isotherm::slam
