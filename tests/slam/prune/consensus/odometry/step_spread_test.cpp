#include "prune/consensus/odometry/step_spread.hpp"

#include <cmath>
#include <numeric>
#include <utility>

#include <gtest/gtest.h>

#include "graph/reversed.hpp"
#include "isotherm/base/random.hpp"
#include "isotherm_test/random_graphs.hpp"
#include "prune/consensus/objective/own_frames.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_tangent;

template <class Pose>
class StepSpreadOf : public testing::Test {
 protected:
  static constexpr int kSteps = 4000;
  static constexpr double kInformation = 400.0;

  /// Steps of `stride` whose translations err as stated and whose turns half as much.
  PoseGraph<Pose> chain(double stride) {
    PoseGraph<Pose> graph;
    graph.poses.resize(kSteps + 1);
    graph.ids.resize(kSteps + 1);
    std::iota(graph.ids.begin(), graph.ids.end(), 0);
    typename Pose::Tangent motion = Pose::Tangent::Zero();
    motion[0] = stride;
    for (Index v = 0; v < kSteps; ++v) {
      Constraint<Pose> step{.from = v, .to = v + 1};
      step.information = kInformation * Pose::Matrix::Identity();
      typename Pose::Tangent error = random_tangent<Pose>(random_, 1.0 / std::sqrt(kInformation));
      error.template tail<Pose::kDof - Pose::kDim>() *= 0.5;
      step.T_from_to = Pose::exp(motion) * Pose::exp(error);
      graph.constraints.push_back(step);
    }
    return graph;
  }

  Random random_{3};
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(StepSpreadOf, Poses);

// Where the robot moves evenly all that varies is error.
TYPED_TEST(StepSpreadOf, IsTheErrorOfEvenSteps) {
  using Pose = TypeParam;
  const auto graph = this->chain(2.0);
  const StepSpread spread = step_spread(graph, edge_roles(graph));
  EXPECT_NEAR(spread.translation, Pose::kDim, 0.05 * Pose::kDim);
  EXPECT_NEAR(spread.rotation, 0.25 * (Pose::kDof - Pose::kDim), 0.05);
}

// And more where it does not: every tenth step it stands.
TYPED_TEST(StepSpreadOf, IsMoreOfUnevenSteps) {
  auto graph = this->chain(2.0);
  const double even = step_spread(graph, edge_roles(graph)).translation;
  for (std::size_t k = 0; k < graph.constraints.size(); k += 10) {
    graph.constraints[k].T_from_to = TypeParam();
  }
  const double stands = step_spread(graph, edge_roles(graph)).translation;
  EXPECT_NEAR(stands - even, 0.1 * 0.9 * 4.0 * this->kInformation, 0.1 * even + 10.0);
}

TYPED_TEST(StepSpreadOf, IsTheSameFromEitherEnd) {
  auto graph = this->chain(2.0);
  const StepSpread forward = step_spread(graph, edge_roles(graph));
  for (std::size_t k = 0; k < graph.constraints.size(); k += 3) {
    graph.constraints[k] = reversed(graph.constraints[k]);
  }
  const auto roles = edge_roles(graph);
  const StepSpread mixed = step_spread(in_own_frames(std::move(graph), roles), roles);
  EXPECT_NEAR(mixed.rotation, forward.rotation, 0.01 * forward.rotation);
  EXPECT_NEAR(mixed.translation, forward.translation, 0.1 * forward.translation);
}

TYPED_TEST(StepSpreadOf, NothingTellsOfNoneOrOne) {
  auto graph = this->chain(2.0);
  EdgeRoles roles;
  EXPECT_EQ(step_spread(graph, roles).translation, 0.0);
  roles.odometry = {0};
  EXPECT_EQ(step_spread(graph, roles).translation, 0.0);
  EXPECT_EQ(step_spread(graph, roles).rotation, 0.0);
}

}  // namespace
}  // namespace isotherm::slam::detail
