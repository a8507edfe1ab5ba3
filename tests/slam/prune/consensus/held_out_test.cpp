#include "prune/consensus/estimate/held_out.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "isotherm/slam/graph/odometry.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kRequired = 9.2;
constexpr int kSteps = 20;

template <class Pose>
class HeldOutLoops : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(HeldOutLoops, Poses);

template <class Pose>
std::int64_t proven(const PoseGraph<Pose>& graph) {
  const auto reduced = reduce(graph, edge_roles(graph));
  const std::vector<bool> accepted(reduced.loops.size(), true);
  Estimate<Pose> estimate(reduced);
  estimate.update(accepted, {}, kSteps);
  const MapVolume<Pose> map(estimate.poses());
  return std::ranges::count_if(
      held_out(reduced, estimate, accepted, 1.0, map),
      [](const HeldOut& loop) { return loop.evidence.log_ratio >= kRequired; });
}

TYPED_TEST(HeldOutLoops, AreAllProvenOnACleanMap) {
  Random random(81);
  auto made = isotherm_test::random_loop_graph<TypeParam>(random, 80, 40, 0.1);
  EXPECT_EQ(proven(made.graph), 40);
  made.graph.constraints.resize(79);
  EXPECT_EQ(proven(made.graph), 0) << "no loops";
}

// Odometry says next to nothing, and every loop that both poses are at the same place.
TYPED_TEST(HeldOutLoops, AreNotProvenOnAMapThatHasShrunkToAPoint) {
  using Pose = TypeParam;
  Random random(82);
  auto made = isotherm_test::random_loop_graph<Pose>(random, 80, 400, 0.1);
  for (auto& constraint : made.graph.constraints) {
    const bool is_step = constraint.to == constraint.from + 1;
    constraint.information = (is_step ? 1e-3 : 1e2) * Pose::Matrix::Identity();
    if (!is_step) {
      constraint.T_from_to = Pose::exp(isotherm_test::random_tangent<Pose>(random, 0.1));
    }
  }
  EXPECT_EQ(proven(made.graph), 0);
}

}  // namespace
}  // namespace isotherm::slam::detail
