#include "isotherm/slam/graph/pose_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Constraint<Pose2> edge(Index from, Index to) {
  Constraint<Pose2> constraint;
  constraint.from = from;
  constraint.to = to;
  return constraint;
}

TEST(EdgeRoles, OdometryIsTheFirstEdgeBetweenNeighboursInEitherDirection) {
  PoseGraph<Pose2> graph;
  graph.ids = {10, 20, 30, 40};
  graph.constraints = {edge(1, 0), edge(0, 1), edge(0, 3), edge(1, 2), edge(2, 2), edge(3, 2)};
  const auto roles = edge_roles(graph);
  EXPECT_THAT(roles.odometry, ElementsAre(0, 3, 5));
  EXPECT_THAT(roles.candidates, ElementsAre(1, 2, 4));
}

TEST(EdgeRoles, RobotsAreNotNeighbours) {
  const VertexId a = VertexId{'a'} << 56;
  const VertexId b = VertexId{'b'} << 56;
  PoseGraph<Pose2> graph;
  graph.ids = {a, a + 1, b, b + 1};
  graph.constraints = {edge(0, 1), edge(1, 2), edge(2, 3)};
  const auto roles = edge_roles(graph);
  EXPECT_THAT(roles.odometry, ElementsAre(0, 2));
  EXPECT_THAT(roles.candidates, ElementsAre(1));
}

// Two sensors on one robot, numbered by turns that are not always in order of time.
TEST(EdgeRoles, WhereNeighboursAreApartOdometryLeadsPastOnePose) {
  PoseGraph<Pose2> graph;
  graph.ids = {0, 1, 2, 3, 4, 5};
  graph.constraints = {edge(0, 2), edge(2, 1), edge(1, 3), edge(1, 3), edge(3, 4), edge(4, 5)};
  auto roles = edge_roles(graph);
  EXPECT_THAT(roles.odometry, ElementsAre(0, 1, 2, 4, 5));
  EXPECT_THAT(roles.candidates, ElementsAre(3));
  graph.constraints.push_back(edge(0, 1));  // no gap is left before 2
  graph.constraints.push_back(edge(2, 5));  // past two
  roles = edge_roles(graph);
  EXPECT_THAT(roles.odometry, ElementsAre(1, 2, 4, 5, 6));
  EXPECT_THAT(roles.candidates, ElementsAre(0, 3, 7));
  graph.constraints[2].link = graph.constraints[3].link = LinkKind::loop;
  EXPECT_THAT(edge_roles(graph).odometry, ElementsAre(1, 4, 5, 6));
}

TEST(EdgeRoles, OfRobotsWhoseIdsAlternate) {
  PoseGraph<Pose2> graph;
  graph.ids = {0, 1, 2, 3};
  graph.robots = {0, 1, 0, 1};
  graph.constraints = {edge(0, 2), edge(0, 1), edge(1, 3)};
  EXPECT_THAT(edge_roles(graph).odometry, ElementsAre(0, 2));
}

TEST(EdgeRoles, AGapBetweenRobotsStays) {
  const VertexId a = VertexId{'a'} << 56;
  const VertexId b = VertexId{'b'} << 56;
  PoseGraph<Pose2> graph;
  graph.ids = {a, a + 1, b, b + 1};
  graph.constraints = {edge(0, 1), edge(2, 3), edge(0, 2), edge(1, 3)};
  EXPECT_THAT(edge_roles(graph).odometry, ElementsAre(0, 1));
}

TEST(EdgeRoles, EmptyGraph) {
  const auto roles = edge_roles(PoseGraph<Pose3>());
  EXPECT_THAT(roles.odometry, IsEmpty());
  EXPECT_THAT(roles.candidates, IsEmpty());
}

TEST(PoseGraph, FindsVerticesById) {
  PoseGraph<Pose2> graph;
  graph.ids = {3, 7, VertexId{1} << 63};
  EXPECT_EQ(graph.find(7), 1);
  EXPECT_EQ(graph.find(VertexId{1} << 63), 2);
  EXPECT_EQ(graph.find(4), std::nullopt);
  EXPECT_EQ(PoseGraph<Pose2>().find(0), std::nullopt);
}

TEST(FilterConstraints, KeepsVerticesAndOrder) {
  PoseGraph<Pose2> graph;
  graph.ids = {0, 1, 2};
  graph.poses = {Pose2(), Pose2(1, 0, 0), Pose2(2, 0, 0)};
  graph.fixed = {0};
  graph.constraints = {edge(0, 1), edge(1, 2), edge(0, 2)};
  const auto kept = filter_constraints(graph, {true, false, true});
  EXPECT_EQ(kept.ids, graph.ids);
  EXPECT_EQ(kept.fixed, graph.fixed);
  EXPECT_EQ(kept.poses.size(), 3u);
  ASSERT_EQ(kept.constraint_count(), 2);
  EXPECT_EQ(kept.constraints[1].to, 2);
  EXPECT_THROW(filter_constraints(graph, {true}), InvalidArgument);
}

TEST(Residual, IsZeroWhereTheMeasurementHoldsAndInTheFrameOfTo) {
  Constraint<Pose2> constraint;
  constraint.T_from_to = Pose2(1.0, 2.0, 0.5);
  const Pose2 from(3.0, -1.0, 1.1);
  EXPECT_LT(residual(constraint, from, from * constraint.T_from_to).norm(), 1e-15);
  const Pose2::Tangent xi(0.1, -0.2, 0.3);
  const Pose2 to = from * constraint.T_from_to * Pose2::exp(xi);
  EXPECT_LT((residual(constraint, from, to) - xi).norm(), 1e-14);
}

}  // namespace
}  // namespace isotherm::slam
