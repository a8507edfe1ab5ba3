#include "online/present_map.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "isotherm/slam/optimize/optimize.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;
using isotherm_test::worst_difference;

// Less than one in a million true loops are that far off.
constexpr double kMostChi2 = 40.0;

template <class Pose>
class PresentMapOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(PresentMapOf, Poses);

// The edges of a graph and one more, the last, from the start of the map to its middle, as if they
// were the same place.
template <class Pose>
struct Contradicted {
  PoseGraph<Pose> graph;
  std::vector<Use> uses;

  Contradicted() {
    Random random(5);
    const auto made = random_loop_graph<Pose>(random, 60, 40, 1.0);
    graph = made.graph;
    graph.poses = made.truth;
    auto wrong = graph.constraints.back();
    wrong.from = 0;
    wrong.to = graph.vertex_count() / 2;
    wrong.T_from_to = Pose();
    graph.constraints.push_back(wrong);
    uses.assign(graph.constraints.size(), {Use::As::loop});
    for (const Index k : edge_roles(graph).odometry) uses[k].as = Use::As::step;
    uses.back().most_chi2 = kMostChi2;
  }
};

TYPED_TEST(PresentMapOf, IsNotBentByALoopThatTheOthersContradict) {
  Contradicted<TypeParam> with;
  const auto given = with.graph.poses;
  settle_poses(with.graph, with.uses, {});
  Contradicted<TypeParam> without;
  without.uses.back().as = Use::As::none;
  settle_poses(without.graph, without.uses, {});
  EXPECT_GT(worst_difference(without.graph.poses, given), 1e-6);
  EXPECT_LT(worst_difference(with.graph.poses, without.graph.poses), 1e-6);
}

// Nearer to the least squares of all than what is given by far.
TYPED_TEST(PresentMapOf, CountsAllLoopsThatWereJudgedTogether) {
  Contradicted<TypeParam> known;
  auto whole = known.graph;
  known.uses.back() = {Use::As::loop};
  settle_poses(known.graph, known.uses, {});
  const auto optimum = optimize(whole, edge_roles(whole), {.cost_tolerance = 1e-12}).poses;
  EXPECT_LT(worst_difference(known.graph.poses, optimum),
            1e-2 * worst_difference(whole.poses, optimum));
}

// Odometry turns a little too far at every step: the loops that came since agree with each other
// and with the way as it was, but none of them fits where odometry has led.
TYPED_TEST(PresentMapOf, FollowsLoopsThatCameTogetherAgainstOdometry) {
  Random random(7);
  const auto made = random_loop_graph<TypeParam>(random, 60, 40, 1.0, 1e8);
  auto graph = made.graph;
  std::vector<Use> uses(graph.constraints.size(), {Use::As::loop, kMostChi2});
  typename TypeParam::Tangent drift = TypeParam::Tangent::Zero();
  drift[TypeParam::kDof - 1] = 0.03;
  for (const Index k : edge_roles(graph).odometry) {
    uses[k] = {Use::As::step};
    auto& step = graph.constraints[k];
    step.T_from_to = step.T_from_to * TypeParam::exp(drift);
    step.information *= 1e-6;
  }
  graph.poses = odometry_poses(graph, edge_roles(graph));
  const auto whole = graph;
  settle_poses(graph, uses, {});
  const auto optimum = optimize(whole, edge_roles(whole), {.cost_tolerance = 1e-12}).poses;
  EXPECT_LT(worst_difference(graph.poses, optimum), 1e-2 * worst_difference(whole.poses, optimum));
}

}  // namespace
}  // namespace isotherm::slam::detail
