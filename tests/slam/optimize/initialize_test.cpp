#include "isotherm/slam/optimize/initialize.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/optimize/optimize.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::random_loop_graph;
using isotherm_test::worst_difference;

template <class Pose>
class Initialize : public testing::Test {
 protected:
  Random random{21};
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(Initialize, Poses);

constexpr Initialization kComputed[] = {Initialization::odometry, Initialization::spanning_tree,
                                        Initialization::chordal, Initialization::switchable};

TYPED_TEST(Initialize, IsExactWithoutNoise) {
  using Pose = TypeParam;
  const auto [graph, truth] = random_loop_graph<Pose>(this->random, 40, 30, 0.0);
  for (const auto method : kComputed) {
    EXPECT_LT(worst_difference(initial_poses(graph, edge_roles(graph), method), truth), 1e-9)
        << enum_name(method);
  }
}

TYPED_TEST(Initialize, StartsFromTheFixedPosesOrTheFirst) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 20, 10, 0.0);
  graph.poses.assign(20, Pose());
  const Pose elsewhere = Pose::exp(isotherm_test::random_tangent<Pose>(this->random, 1.0));
  graph.poses[7] = elsewhere * truth[7];
  graph.fixed = {7};
  for (auto& pose : truth) pose = elsewhere * pose;
  for (const auto method : kComputed) {
    EXPECT_LT(worst_difference(initial_poses(graph, edge_roles(graph), method), truth), 1e-9)
        << enum_name(method);
  }
}

TYPED_TEST(Initialize, OdometryIsNotBentByAFalseLoop) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 30, 5, 0.0);
  for (const Index k : edge_roles(graph).candidates) graph.constraints[k].T_from_to = Pose();
  const auto poses = initial_poses(graph, edge_roles(graph), Initialization::odometry);
  EXPECT_LT(worst_difference(poses, truth), 1e-9);
}

TYPED_TEST(Initialize, SwitchableIsThatOptimumFromOdometry) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 30, 12, 0.1);
  graph.constraints.back().T_from_to = Pose();  // a false loop
  const auto optimum = optimize(graph, {.kernel = RobustKernel::sc, .cost_tolerance = 1e-6});
  const auto poses = initial_poses(graph, edge_roles(graph), Initialization::switchable);
  EXPECT_LT(worst_difference(poses, optimum.poses), 1e-9);
}

TYPED_TEST(Initialize, ComponentsAndLonelyVerticesStayWhereTheyWere) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 20, 0, 0.0);
  graph.constraints.erase(graph.constraints.begin() + 9);  // between vertices 9 and 10
  graph.ids.push_back(20);
  graph.poses = truth;
  graph.poses.push_back(Pose::exp(isotherm_test::random_tangent<Pose>(this->random, 1.0)));
  for (const auto method : kComputed) {
    EXPECT_LT(worst_difference(initial_poses(graph, edge_roles(graph), method), graph.poses), 1e-9)
        << enum_name(method);
  }
}

TYPED_TEST(Initialize, FromTheFile) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 5, 2, 0.0);
  const EdgeRoles roles = edge_roles(graph);
  EXPECT_THROW(initial_poses(graph, roles, Initialization::file), InvalidArgument);
  graph.poses = truth;
  EXPECT_EQ(worst_difference(initial_poses(graph, roles, Initialization::file), truth), 0.0);
  graph.poses.pop_back();
  EXPECT_THROW(initial_poses(graph, roles, Initialization::odometry), InvalidArgument);
}

TYPED_TEST(Initialize, EmptyGraph) {
  for (const auto method :
       {Initialization::odometry, Initialization::spanning_tree, Initialization::chordal,
        Initialization::file, Initialization::switchable}) {
    EXPECT_TRUE(initial_poses(PoseGraph<TypeParam>(), {}, method).empty());
  }
}

}  // namespace
}  // namespace isotherm::slam
