#include "isotherm/slam/graph/graph_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm::slam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

Constraint<Pose2> step(Index from, Index to, double length) {
  Constraint<Pose2> constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.T_from_to = Pose2(length, 0, 0);
  return constraint;
}

PoseGraph<Pose2> line_graph(Index vertices) {
  PoseGraph<Pose2> graph;
  for (Index v = 0; v < vertices; ++v) {
    graph.ids.push_back(v);
    graph.poses.emplace_back(v, 0, 0);
    if (v > 0) graph.constraints.push_back(step(v - 1, v, 1));
  }
  return graph;
}

TEST(Summarize, EmptyGraph) {
  const auto summary = summarize(PoseGraph<Pose3>());
  EXPECT_EQ(summary.vertices, 0u);
  EXPECT_EQ(summary.components, 0u);
  EXPECT_FALSE(summary.drift.has_value());
  EXPECT_THAT(summary.suspicious, IsEmpty());
}

TEST(Summarize, CleanChain) {
  const auto summary = summarize(line_graph(5));
  EXPECT_EQ(summary.dimension, 2);
  EXPECT_EQ(summary.odometry, 4u);
  EXPECT_EQ(summary.candidates, 0u);
  EXPECT_EQ(summary.components, 1u);
  EXPECT_EQ(summary.odometry_chains, 1u);
  EXPECT_EQ(summary.odometry_information.distinct, 1u);
  EXPECT_EQ(summary.odometry_information.worst_condition, 1.0);
  EXPECT_EQ(summary.odometry_information.median_rotation_sigma, 1.0);
  ASSERT_TRUE(summary.drift.has_value());
  EXPECT_EQ(summary.drift->path_length, 4.0);
  EXPECT_LT(summary.drift->max_distance, 1e-14);
  EXPECT_THAT(summary.suspicious, IsEmpty());
}

TEST(Summarize, DriftOfOdometryAgainstVertices) {
  auto graph = line_graph(3);
  graph.poses[1] = Pose2(1, 3, 0);
  graph.poses[2] = Pose2(2, 0, 0.25);
  const auto drift = summarize(graph).drift.value();
  EXPECT_NEAR(drift.max_distance, 3.0, 1e-14);
  EXPECT_EQ(drift.max_vertex, 1u);
  EXPECT_NEAR(drift.mean_distance, 1.0, 1e-14);
  EXPECT_LT(drift.end_distance, 1e-14);
  EXPECT_NEAR(drift.end_rotation, 0.25, 1e-14);
}

TEST(Summarize, ListsWhatIsOdd) {
  auto graph = line_graph(8);
  graph.constraints.erase(graph.constraints.begin() + 3);  // 3 -> 4
  graph.constraints[0].T_from_to = Pose2(1000, 0, 0);
  graph.constraints[1].information *= 1e12;
  graph.constraints[2].information.setZero();
  graph.constraints.push_back(step(2, 1, 1));
  graph.constraints.push_back(step(5, 5, 1));
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) graph.constraints[k].line = k + 1;
  const auto summary = summarize(graph);
  EXPECT_EQ(summary.components, 2u);
  EXPECT_EQ(summary.largest_component, 4u);
  EXPECT_EQ(summary.repeated_edges, 1u);
  EXPECT_EQ(summary.self_edges, 1u);
  EXPECT_EQ(summary.odometry_information.singular, 1u);
  EXPECT_THAT(
      summary.suspicious,
      ElementsAre(Pair("broken odometry", 1), Pair("long odometry step", 1),
                  Pair("not connected", 1), Pair("outlying information", 4),
                  Pair("repeated pair", 1), Pair("self edge", 1), Pair("singular information", 1)));
  EXPECT_EQ(summary.suspicions[0].line, 8u);
  EXPECT_EQ(summary.suspicions[0].message, "edge from vertex 5 to itself");
}

TEST(Summarize, CountsRobotsAndGaps) {
  PoseGraph<Pose2> graph;
  graph.ids = {VertexId{'a'} << 56, (VertexId{'a'} << 56) + 1, VertexId{'b'} << 56};
  graph.constraints = {step(0, 1, 1), step(1, 2, 1)};
  const auto summary = summarize(graph);
  EXPECT_EQ(summary.robots, 2u);
  EXPECT_EQ(summary.odometry_chains, 2u);
  EXPECT_EQ(summary.consecutive_edges, 1u);
  EXPECT_THAT(summary.suspicious, IsEmpty());
}

}  // namespace
}  // namespace isotherm::slam
