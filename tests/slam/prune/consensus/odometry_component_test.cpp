#include "prune/consensus/estimate/odometry_component.hpp"

#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "graph/reversed.hpp"
#include "isotherm/base/random.hpp"
#include "prune/consensus/climb/assessment.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

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

template <class Pose>
Explanation<Pose> everything_at(const Objective<Pose>& objective,
                                const typename Pose::Tangent& logs) {
  const std::size_t loops = objective.stated().reduced.loops.size();
  Explanation<Pose> all{.accepted = std::vector<bool>(loops, true)};
  all.weights.resize(loops);
  all.scale.odometry = std::exp(logs.mean());
  all.shapes.odometry = (logs.array() - logs.mean()).exp();
  return all;
}

template <class Pose>
double evidence_at(const Objective<Pose>& objective, const typename Pose::Tangent& logs) {
  const auto all = everything_at(objective, logs);
  const auto graph = objective.scaled(all.shapes);
  Estimate<Pose> estimate(graph.reduced);
  estimate.update(all.accepted, all.scale, 20);
  return objective.fit(all, graph, estimate, {}) + objective.log_scale_peak(all);
}

TYPED_TEST(OdometryComponentOf, IsTheDerivativeOfTheEvidence) {
  using Pose = TypeParam;
  const Sample<Pose> sample(1.0);
  const Objective<Pose> objective(sample.graph, sample.roles, 20, false);
  typename Pose::Tangent logs;
  for (int d = 0; d < Pose::kDof; ++d) logs[d] = 0.4 * d - 0.7;
  const auto all = everything_at(objective, logs);
  const auto graph = objective.scaled(all.shapes);
  Estimate<Pose> estimate(graph.reduced);
  estimate.update(all.accepted, all.scale, 20);
  std::vector<const Link<Pose>*> steps;
  for (const auto& step : graph.reduced.steps) steps.push_back(&step);
  ASSERT_LT(steps.size(), 12U);  // contracted
  ASSERT_GT(steps.size(), graph.reduced.contracted);
  const auto found = objective.odometry(all, graph, estimate, estimate.residual_covariances(steps));
  for (int d = 0; d < Pose::kDof; ++d) {
    constexpr double kStep = 1e-3;
    const typename Pose::Tangent more = kStep * Pose::Tangent::Unit(d);
    const double expected = (evidence_at(objective, typename Pose::Tangent(logs + more)) -
                             evidence_at(objective, typename Pose::Tangent(logs - more))) /
                            (2.0 * kStep);
    EXPECT_NEAR(0.5 * (found.cost[d] / all.scale.odometry - found.redundancy[d]), expected, 0.02);
    EXPECT_GT(found.redundancy[d], 0.0);
  }
}

TYPED_TEST(OdometryComponentOf, LeavesWhatTheLoopsDoNot) {
  using Pose = TypeParam;
  const Sample<Pose> sample(1.0);
  const Objective<Pose> objective(sample.graph, sample.roles, 20);
  const auto all = everything_at(objective, Pose::Tangent::Zero());
  Estimate<Pose> estimate(objective.stated().reduced);
  estimate.update(all.accepted, all.scale, 20);
  const auto& graph = objective.stated().reduced;
  std::vector<const Link<Pose>*> links;
  for (const auto& step : graph.steps) links.push_back(&step);
  for (const auto& loop : graph.loops) links.push_back(&loop);
  const auto covariances = estimate.residual_covariances(links);
  const std::span of_steps(covariances.data(), graph.steps.size());
  double left = objective.odometry(all, objective.stated(), estimate, of_steps).redundancy.sum();
  for (std::size_t k = graph.steps.size(); k < links.size(); ++k) {
    left += Pose::kDof - (links[k]->information * covariances[k]).trace();
  }
  const auto free = static_cast<double>(estimate.variable_count());
  EXPECT_NEAR(left, Pose::kDof * (static_cast<double>(links.size()) - free), 1e-5);
}

// Where nothing contradicts odometry nothing is told.
TYPED_TEST(OdometryComponentOf, TellsNothingOfOdometryAlone) {
  using Pose = TypeParam;
  const Sample<Pose> sample(0.0);
  const Objective<Pose> objective(sample.graph, edge_roles(sample.graph), 20);
  auto none = everything_at(objective, Pose::Tangent::Zero());
  none.accepted.assign(none.accepted.size(), false);
  Assessment<Pose> assessment(objective);
  assessment.assess(none);
  EXPECT_EQ(none.redundancy.odometry.sum(), 0.0);
  EXPECT_EQ(none.odometry_cost.sum(), 0.0);
}

}  // namespace
}  // namespace isotherm::slam::detail
