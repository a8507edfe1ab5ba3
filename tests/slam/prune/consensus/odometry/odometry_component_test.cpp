#include "prune/consensus/odometry/odometry_component.hpp"

#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "graph/reversed.hpp"
#include "isotherm/base/random.hpp"
#include "prune/consensus/climb/assessment.hpp"
#include "slam/loop_graph.hpp"
#include "slam/prune/consensus/all_accepted.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::AllAccepted;
using isotherm_test::random_loop_graph;

template <class Pose>
class OdometryComponentOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(OdometryComponentOf, Poses);

// Chains of several edges between the ends of loops, some told backwards, and a trusted edge that
// is in none of them.
template <class Pose>
struct Sample {
  explicit Sample(double noise) {
    Random random(21);
    graph = random_loop_graph<Pose>(random, 25, 5, noise, 1e6).graph;
    for (const Index k : {3, 11}) graph.constraints[k] = reversed(graph.constraints[k]);
    roles = edge_roles(graph);
    roles.odometry.push_back(roles.candidates.back());
    roles.candidates.pop_back();
  }

  PoseGraph<Pose> graph;
  EdgeRoles roles;
};

// With these logs of the factors on odometry's variances.
template <class Pose>
AllAccepted<Pose> everything_at(const Objective<Pose>& objective,
                                const typename Pose::Tangent& logs) {
  return {objective,
          {.odometry = std::exp(logs.mean())},
          {.odometry = (logs.array() - logs.mean()).exp()}};
}

TYPED_TEST(OdometryComponentOf, IsTheDerivativeOfTheEvidence) {
  using Pose = TypeParam;
  const Sample<Pose> sample(1.0);
  const Objective<Pose> objective(sample.graph, sample.roles, 20, false);
  typename Pose::Tangent logs;
  for (int d = 0; d < Pose::kDof; ++d) logs[d] = 0.4 * d - 0.7;
  const auto all = everything_at(objective, logs);
  const auto& steps = all.graph().reduced.steps;
  ASSERT_LT(steps.size(), 12U);  // contracted
  ASSERT_GT(steps.size(), all.graph().reduced.contracted);
  const auto found = objective.odometry(all.explanation(), all.graph(), all.steps());
  for (int d = 0; d < Pose::kDof; ++d) {
    constexpr double kStep = 1e-3;
    const typename Pose::Tangent more = kStep * Pose::Tangent::Unit(d);
    const double expected = (everything_at<Pose>(objective, logs + more).evidence() -
                             everything_at<Pose>(objective, logs - more).evidence()) /
                            (2.0 * kStep);
    EXPECT_NEAR(0.5 * (found.cost[d] / all.explanation().scale.odometry - found.redundancy[d]),
                expected, 0.02);
    EXPECT_GT(found.redundancy[d], 0.0);
  }
}

TYPED_TEST(OdometryComponentOf, LeavesWhatTheLoopsDoNot) {
  using Pose = TypeParam;
  const Sample<Pose> sample(1.0);
  const Objective<Pose> objective(sample.graph, sample.roles, 20);
  const auto all = everything_at<Pose>(objective, Pose::Tangent::Zero());
  const auto& graph = all.graph().reduced;
  std::vector<const Link<Pose>*> loops;
  for (const auto& loop : graph.loops) loops.push_back(&loop);
  const auto covariances = all.estimate().residual_covariances(loops);
  double left = objective.odometry(all.explanation(), all.graph(), all.steps()).redundancy.sum();
  for (std::size_t k = 0; k < loops.size(); ++k) {
    left += Pose::kDof - (loops[k]->information * covariances[k]).trace();
  }
  const auto links = static_cast<double>(graph.steps.size() + loops.size());
  const auto free = static_cast<double>(all.estimate().variable_count());
  EXPECT_NEAR(left, Pose::kDof * (links - free), 1e-5);
}

// Where nothing contradicts odometry nothing is told.
TYPED_TEST(OdometryComponentOf, TellsNothingOfOdometryAlone) {
  using Pose = TypeParam;
  const Sample<Pose> sample(0.0);
  const Objective<Pose> objective(sample.graph, edge_roles(sample.graph), 20);
  auto none = everything_at<Pose>(objective, Pose::Tangent::Zero()).explanation();
  none.accepted.assign(none.accepted.size(), false);
  Assessment<Pose> assessment(objective);
  assessment.assess(none);
  EXPECT_EQ(none.redundancy.odometry.sum(), 0.0);
  EXPECT_EQ(none.odometry_cost.sum(), 0.0);
}

}  // namespace
}  // namespace isotherm::slam::detail
