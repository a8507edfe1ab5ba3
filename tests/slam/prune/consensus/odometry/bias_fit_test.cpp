#include "prune/consensus/odometry/bias_fit.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/random.hpp"
#include "prune/consensus/objective/objective.hpp"
#include "prune/consensus/objective/own_frames.hpp"
#include "slam/loop_graph.hpp"
#include "slam/prune/consensus/all_accepted.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::AllAccepted;
using isotherm_test::random_loop_graph;

template <class Pose>
class BiasFitOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(BiasFitOf, Poses);

template <class Pose>
TurnBias<Pose> bias_of(double size) {
  TurnBias<Pose> bias;
  for (Eigen::Index d = 0; d < bias.size(); ++d)
    bias[d] = size * (1.0 - 0.6 * static_cast<double>(d));
  return bias;
}

// Several edges between the ends of loops, a third told backwards; odometry tells too little of
// each turn by `bias`.
template <class Pose>
PoseGraph<Pose> graph_with(const TurnBias<Pose>& bias, double noise = 1.0) {
  Random random(7);
  auto graph = random_loop_graph<Pose>(random, 25, 6, noise, 1e6).graph;
  const auto roles = edge_roles(graph);
  isotherm_test::turn_less(graph, roles.odometry, bias);
  return in_own_frames(graph, roles);
}

// Of the loops, where each edge of odometry is in error by so much and has this bias.
template <class Pose>
Eigen::VectorXd residuals(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                          const Chain<Pose>& chain, const std::vector<typename Pose::Tangent>& off,
                          const TurnBias<Pose>& bias) {
  std::vector<Pose> poses = {Pose()};
  for (std::size_t v = 0; v + 1 < graph.ids.size(); ++v) {
    const Pose T = turned(chain[v]->T, bias);
    const Pose error = Pose::exp(off[v]);
    poses.push_back(poses.back() * (chain[v]->forward ? T * error : error * T));
  }
  Eigen::VectorXd r(static_cast<Eigen::Index>(roles.candidates.size()) * Pose::kDof);
  for (std::size_t k = 0; k < roles.candidates.size(); ++k) {
    const auto& loop = graph.constraints[roles.candidates[k]];
    r.template segment<Pose::kDof>(static_cast<Eigen::Index>(k) * Pose::kDof) =
        loop.T_from_to.between(poses[loop.from].between(poses[loop.to])).log();
  }
  return r;
}

/// What odometry alone says of the loops' residuals, by differences, with the bias normal.
template <class Pose>
struct Dense {
  Dense(const PoseGraph<Pose>& graph, const EdgeRoles& roles, const TurnBias<Pose>& variance) {
    constexpr double kStep = 1e-6;
    const auto chain = chain_of(graph, roles);
    std::vector<typename Pose::Tangent> off(chain.size(), Pose::Tangent::Zero());
    TurnBias<Pose> bias = TurnBias<Pose>::Zero();
    r = residuals(graph, roles, chain, off, bias);
    covariance = Eigen::MatrixXd::Zero(r.size(), r.size());
    const auto derivative = [&](double& entry) -> Eigen::VectorXd {
      entry = kStep;
      const Eigen::VectorXd more = residuals(graph, roles, chain, off, bias);
      entry = -kStep;
      const Eigen::VectorXd less = residuals(graph, roles, chain, off, bias);
      entry = 0.0;
      return (more - less) / (2.0 * kStep);
    };
    for (std::size_t v = 0; v + 1 < graph.ids.size(); ++v) {
      Eigen::MatrixXd J(r.size(), Pose::kDof);
      for (int d = 0; d < Pose::kDof; ++d) J.col(d) = derivative(off[v][d]);
      covariance += J * chain[v]->covariance * J.transpose();
    }
    by_bias.resize(r.size(), bias.size());
    for (Eigen::Index d = 0; d < bias.size(); ++d) by_bias.col(d) = derivative(bias[d]);
    with_bias = covariance + by_bias * variance.asDiagonal() * by_bias.transpose();
  }

  Eigen::VectorXd r;
  Eigen::MatrixXd covariance;
  Eigen::MatrixXd by_bias;
  Eigen::MatrixXd with_bias;
};

double dense_log_normal(const Eigen::VectorXd& r, const Eigen::MatrixXd& S) {
  const Eigen::LLT<Eigen::MatrixXd> factor(S);
  const double log_det = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (r.dot(factor.solve(r)) + log_det +
                 static_cast<double>(r.size()) * std::log(2.0 * std::numbers::pi));
}

template <class Pose>
Eigen::MatrixXd of_loops(const ReducedGraph<Pose>& graph) {
  const auto size = static_cast<Eigen::Index>(graph.loops.size()) * Pose::kDof;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t k = 0; k < graph.loops.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k) * Pose::kDof;
    all.template block<Pose::kDof, Pose::kDof>(at, at) = graph.loops[k].covariance;
  }
  return all;
}

template <class Pose>
BiasFit<Pose> fit_of(const Objective<Pose>& objective, const AllAccepted<Pose>& all) {
  return {all.estimate(), all.graph().reduced, objective.bias_prior(all.explanation(), all.graph()),
          1.0};
}

TYPED_TEST(BiasFitOf, AddsToTheEvidenceWhatTheMarginalLikelihoodHas) {
  using Pose = TypeParam;
  const auto graph = graph_with<Pose>(bias_of<Pose>(2e-3));
  const auto roles = edge_roles(graph);
  const Objective<Pose> objective(graph, roles, 20);
  const AllAccepted<Pose> all(objective, {}, {});
  const auto prior = objective.bias_prior(all.explanation(), all.graph());
  ASSERT_LT(all.graph().reduced.steps.size(), 12U);  // contracted
  const Dense<Pose> dense(graph, roles, prior.variance);
  const Eigen::MatrixXd own = of_loops(objective.stated().reduced);
  const double expected = dense_log_normal(dense.r, dense.with_bias + own) -
                          dense_log_normal(dense.r, dense.covariance + own);
  const BiasFit<Pose> fit = fit_of(objective, all);
  EXPECT_NEAR(fit.log_evidence(), expected, 0.05);
}

TYPED_TEST(BiasFitOf, FindsWhatWasTakenAway) {
  using Pose = TypeParam;
  const TurnBias<Pose> bias = bias_of<Pose>(2e-3);
  const auto graph = graph_with<Pose>(bias, 0.01);
  const auto roles = edge_roles(graph);
  const Objective<Pose> objective(graph, roles, 20);
  TurnBias<Pose> now = TurnBias<Pose>::Zero();
  double gain = 1.0;
  for (int step = 0; step < 4; ++step) {
    const AllAccepted<Pose> all(objective, {}, {.bias = now});
    auto prior = objective.bias_prior(all.explanation(), all.graph());
    prior.variance *= 1e6;  // nothing is known of it before
    const BiasFit<Pose> fit(all.estimate(), all.graph().reduced, prior, 1.0);
    now = fit.likeliest();
    gain = fit.gain();
  }
  EXPECT_LT((now - bias).norm(), 0.05 * bias.norm());
  EXPECT_LT(gain, 1e-6);
}

// What a loop that is not accepted may measure.
TYPED_TEST(BiasFitOf, SpreadsWhatIsPredicted) {
  using Pose = TypeParam;
  const auto graph = graph_with<Pose>(TurnBias<Pose>::Zero());
  const auto roles = edge_roles(graph);
  const Objective<Pose> objective(graph, roles, 20);
  const auto& reduced = objective.stated().reduced;
  Estimate<Pose> estimate(reduced);
  Explanation<Pose> none{.accepted = std::vector<bool>(reduced.loops.size(), false)};
  estimate.update(none.accepted, none.scale, 5);
  const auto prior = objective.bias_prior(none, objective.stated());
  const BiasFit<Pose> fit(estimate, reduced, prior, 1.0);
  EXPECT_NEAR(fit.log_evidence(), 0.0, 1e-6);
  const Dense<Pose> dense(graph, roles, prior.variance);
  const Eigen::MatrixXd expected = dense.with_bias - dense.covariance;
  for (std::size_t k = 0; k < reduced.loops.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k) * Pose::kDof;
    const typename Pose::Matrix block = expected.template block<Pose::kDof, Pose::kDof>(at, at);
    EXPECT_LT((fit.of_loop(reduced.loops[k]).P - block).norm(), 1e-3 * block.norm()) << k;
  }
}

TYPED_TEST(BiasFitOf, IsNoneWhereScalesAreKnown) {
  using Pose = TypeParam;
  const auto graph = graph_with<Pose>(bias_of<Pose>(2e-3));
  const Objective<Pose> objective(graph, edge_roles(graph), 20, false);
  const BiasFit<Pose> fit = fit_of(objective, AllAccepted<Pose>(objective, {}, {}));
  EXPECT_TRUE(fit.likeliest().isZero(0.0));
  EXPECT_EQ(fit.gain(), 0.0);
  EXPECT_EQ(fit.log_evidence(), 0.0);
}

// Poses that follow a bias are where odometry with that bias has them, however far it turns them.
TYPED_TEST(BiasFitOf, PosesFollowItFar) {
  using Pose = TypeParam;
  Random random(3);
  const auto graph = random_loop_graph<Pose>(random, 400, 150, 1.0, 1e6).graph;
  const Objective<Pose> objective(graph, edge_roles(graph), 20);
  const auto& stated = objective.stated().reduced;
  const TurnBias<Pose> bias = bias_of<Pose>(5e-3);
  Estimate<Pose> estimate(stated);
  estimate.update(std::vector<bool>(stated.loops.size(), false), {}, 5);
  Explanation<Pose> none;
  const BiasFit<Pose> fit(estimate, stated, objective.bias_prior(none, objective.stated()), 1.0);
  estimate.follow(fit.moves(bias));
  const auto biased = objective.scaled({.bias = bias}).reduced;
  for (const auto& step : biased.steps) {
    const Pose T = estimate.poses()[step.a].between(estimate.poses()[step.b]);
    EXPECT_LT(step.T_a_b.between(T).log().norm(), 2e-3);
  }
  EXPECT_GT(stated.poses.back().between(biased.poses.back()).log().norm(), 0.5);
}

}  // namespace
}  // namespace isotherm::slam::detail
