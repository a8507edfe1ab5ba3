#include "prune/consensus/estimate/vertex_poses.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "isotherm/slam/optimize/optimize.hpp"
#include "prune/consensus/estimate/estimate.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;

template <class Pose>
class VertexPosesOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(VertexPosesOf, Poses);

// Vertices that loops leave out lie where the optimum of the whole graph has them.
TYPED_TEST(VertexPosesOf, AreThoseOfTheWholeGraphsOptimum) {
  using Pose = TypeParam;
  Random random(11);
  const auto made = random_loop_graph<Pose>(random, 60, 8, 0.1, 1e6);
  const auto reduced = reduce(made.graph, edge_roles(made.graph));
  Estimate<Pose> estimate(reduced);
  estimate.update(std::vector<bool>(reduced.loops.size(), true), {}, 10);
  const auto whole = optimize(made.graph);
  const Pose shift = estimate.poses().front() * whole.poses[reduced.vertex.front()].inverse();
  for (Index v = 0; v < made.graph.vertex_count(); ++v) {
    const auto pose = pose_of(reduced, estimate.poses(), v);
    ASSERT_TRUE(pose);
    EXPECT_LT(((shift * whole.poses[v]).inverse() * *pose).log().norm(), 1e-5) << v;
  }
}

TYPED_TEST(VertexPosesOf, AnchorIsTheNearestNode) {
  using Pose = TypeParam;
  Random random(12);
  const auto made = random_loop_graph<Pose>(random, 60, 6, 0.1, 1e6);
  const auto reduced = reduce(made.graph, edge_roles(made.graph));
  for (Index v = 0; v < made.graph.vertex_count(); ++v) {
    const auto anchor = nearest_node(reduced, v);
    ASSERT_TRUE(anchor);
    for (const Index other : reduced.vertex) {
      EXPECT_LE(std::abs(reduced.vertex[anchor->node] - v), std::abs(other - v));
    }
    const Pose there = reduced.odometry.relative(reduced.vertex[anchor->node], v).T;
    EXPECT_LT((there.inverse() * anchor->path.T).log().norm(), 1e-12);
  }
}

// Odometry that breaks off, and no loop beyond.
TYPED_TEST(VertexPosesOf, AreUnknownWhereNoNodeIsOnTheChain) {
  using Pose = TypeParam;
  Random random(13);
  auto graph = random_loop_graph<Pose>(random, 20, 0, 0.1).graph;
  graph.constraints.erase(graph.constraints.begin() + 9);  // from 9 to 10
  auto loop = graph.constraints.front();
  loop.from = 0;
  loop.to = 5;
  graph.constraints.push_back(loop);
  const auto reduced = reduce(graph, edge_roles(graph));
  EXPECT_TRUE(pose_of(reduced, reduced.poses, 9));
  EXPECT_FALSE(pose_of(reduced, reduced.poses, 10));
  EXPECT_FALSE(nearest_node(reduced, 19));
}

}  // namespace
}  // namespace isotherm::slam::detail
