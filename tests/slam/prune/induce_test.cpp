#include "isotherm/slam/prune/induce.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/prune/odometry_chi2.hpp"
#include "isotherm_test/random_graphs.hpp"

namespace isotherm::slam {
namespace {

PoseGraph<Pose2> chain_with_loops() {
  Random random(31);
  auto graph = isotherm_test::random_chain<Pose2>(random, 8);
  const auto poses = odometry_poses(graph, edge_roles(graph));
  Constraint<Pose2> good;
  good.from = 0;
  good.to = 6;
  good.T_from_to = poses[0].inverse() * poses[6];
  Constraint<Pose2> bad = good;
  bad.from = 1;
  bad.T_from_to = good.T_from_to * Pose2(30.0, 0.0, 1.0);
  bad.information *= 1e4;
  graph.constraints.insert(graph.constraints.begin() + 2, bad);
  graph.constraints.push_back(good);
  return graph;
}

TEST(Induce, OdometryKeepsItsWeightAndLoopsFollowChi2) {
  const auto graph = chain_with_loops();
  const auto roles = edge_roles(graph);
  const auto checks = odometry_chi2(graph, roles);
  const auto induced = induce(graph, roles, {.odometry_weight = 2.0, .loop_weight = 0.5});
  ASSERT_EQ(induced.graph.edge_count(), graph.constraint_count());
  for (const Index k : roles.odometry) {
    EXPECT_EQ(induced.graph.edge(induced.constraint_edge[k]).weight, 2.0);
  }
  for (std::size_t c = 0; c < roles.candidates.size(); ++c) {
    const auto& edge = induced.graph.edge(induced.constraint_edge[roles.candidates[c]]);
    EXPECT_EQ(edge.weight, 0.5 / (1.0 + checks[c].chi2 / 3.0));
  }
  EXPECT_NEAR(induced.graph.edge(induced.constraint_edge.back()).weight, 0.5, 1e-9);
}

TEST(Induce, UniformWeights) {
  const auto graph = chain_with_loops();
  const auto induced =
      induce(graph, edge_roles(graph), {.weights = LoopWeights::uniform, .loop_weight = 0.25});
  EXPECT_EQ(induced.graph.edge(2).weight, 0.25);
  EXPECT_EQ(induced.graph.edge(0).weight, 1.0);
}

TEST(Induce, CurvesWeightLoopsAloneOrTogetherWithChi2) {
  const auto graph = chain_with_loops();
  const auto roles = edge_roles(graph);
  InductionOptions options{.weights = LoopWeights::lap_line, .loop_weight = 0.5};
  options.curve.windows = {2.0};
  options.curve.step = 0.25;
  const auto checks = odometry_chi2(graph, roles);
  const auto evidence = curve_evidence(graph, roles, options.curve);
  const auto by_curve = induce(graph, roles, options);
  options.weights = LoopWeights::both;
  const auto by_both = induce(graph, roles, options);
  for (std::size_t c = 0; c < roles.candidates.size(); ++c) {
    const auto edge = by_curve.constraint_edge[roles.candidates[c]];
    EXPECT_EQ(by_curve.graph.edge(edge).weight, 0.5 * (1.0 - evidence[c].score));
    EXPECT_DOUBLE_EQ(by_both.graph.edge(edge).weight,
                     0.5 / (1.0 + checks[c].chi2 / 3.0) * (1.0 - evidence[c].score));
  }
}

TEST(Induce, WeightsThatUnderflowHaveNoEdge) {
  auto graph = chain_with_loops();
  const double tiny = std::numeric_limits<double>::denorm_min();
  const auto induced = induce(graph, edge_roles(graph), {.loop_weight = tiny});
  EXPECT_EQ(induced.constraint_edge[2], -1);
  EXPECT_EQ(induced.graph.edge_count(), graph.constraint_count() - 1);
  EXPECT_EQ(induced.edge_constraint[2], 3);
}

TEST(Induce, RejectsBadWeights) {
  const auto graph = chain_with_loops();
  EXPECT_THROW(induce(graph, edge_roles(graph), {.odometry_weight = 0.0}), InvalidArgument);
  EXPECT_THROW(induce(graph, edge_roles(graph), {.loop_weight = -1.0}), InvalidArgument);
}

TEST(Induce, EmptyGraph) {
  const auto induced = induce(PoseGraph<Pose3>(), EdgeRoles());
  EXPECT_EQ(induced.graph.vertex_count(), 0);
}

}  // namespace
}  // namespace isotherm::slam
