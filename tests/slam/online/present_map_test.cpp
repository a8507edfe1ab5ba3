#include "online/present_map.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;
using isotherm_test::worst_difference;

template <class Pose>
class PresentMapOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(PresentMapOf, Poses);

// The edges of the graph and one more, from the start of the map to its middle, as if they were
// the same place.
TYPED_TEST(PresentMapOf, IsNotBentByALoopThatTheOthersContradict) {
  using Pose = TypeParam;
  Random random(5);
  const auto made = random_loop_graph<Pose>(random, 60, 40, 1.0);
  auto graph = made.graph;
  graph.poses = made.truth;
  auto wrong = graph.constraints.back();
  wrong.from = 0;
  wrong.to = graph.vertex_count() / 2;
  wrong.T_from_to = Pose();
  graph.constraints.push_back(wrong);
  std::vector<bool> steps(graph.constraints.size(), false);
  for (const Index k : edge_roles(graph).odometry) steps[k] = true;
  std::vector<bool> used(graph.constraints.size(), true);
  auto with = graph;
  settle_poses(with, steps, used, {});
  used.back() = false;
  auto without = graph;
  settle_poses(without, steps, used, {});
  EXPECT_GT(worst_difference(without.poses, graph.poses), 1e-6);
  EXPECT_LT(worst_difference(with.poses, without.poses), 1e-6);
}

}  // namespace
}  // namespace isotherm::slam::detail
