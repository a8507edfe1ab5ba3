#include "prune/consensus/objective/objective.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/random.hpp"
#include "prune/consensus/climb/climb.hpp"
#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/consensus/objective/run_density.hpp"
#include "prune/consensus/pairs/loop_pair.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;

template <class Pose>
class ObjectiveOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(ObjectiveOf, Poses);

// log p(z_A | odometry) by dense algebra: the residuals of the loops under odometry are normal,
// with covariance Sigma + J blockdiag(odometry) J', J by differences.
template <class Pose>
double dense_log_likelihood(const ReducedGraph<Pose>& graph, const CovarianceScale& scale) {
  constexpr int kDof = Pose::kDof;
  constexpr double kStep = 1e-6;
  const auto residuals = [&](const std::vector<Pose>& steps) {
    std::vector<Pose> poses = {Pose()};
    for (const Pose& step : steps) poses.push_back(poses.back() * step);
    Eigen::VectorXd r(static_cast<Eigen::Index>(graph.loops.size()) * kDof);
    for (std::size_t k = 0; k < graph.loops.size(); ++k) {
      const auto& loop = graph.loops[k];
      r.template segment<kDof>(static_cast<Eigen::Index>(k) * kDof) =
          (loop.T_a_b.inverse() * (poses[loop.a].inverse() * poses[loop.b])).log();
    }
    return r;
  };
  std::vector<Pose> steps;
  for (const auto& step : graph.steps) steps.push_back(step.T_a_b);
  const Eigen::VectorXd r = residuals(steps);
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(r.size(), r.size());
  for (std::size_t s = 0; s < steps.size(); ++s) {
    Eigen::MatrixXd J(r.size(), kDof);
    for (int d = 0; d < kDof; ++d) {
      const auto moved = [&](double by) {
        auto bent = steps;
        typename Pose::Tangent xi = Pose::Tangent::Zero();
        xi[d] = by;
        bent[s] = bent[s] * Pose::exp(xi);
        return residuals(bent);
      };
      J.col(d) = (moved(kStep) - moved(-kStep)) / (2.0 * kStep);
    }
    S += scale.odometry * J * graph.steps[s].covariance * J.transpose();
  }
  for (std::size_t k = 0; k < graph.loops.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k) * kDof;
    S.template block<kDof, kDof>(at, at) += scale.loops * graph.loops[k].covariance;
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(S);
  const double log_det = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (r.dot(factor.solve(r)) + log_det +
                 static_cast<double>(r.size()) * std::log(2.0 * std::numbers::pi));
}

template <class Pose>
double evidence_of(const Objective<Pose>& objective, Estimate<Pose>& estimate,
                   Explanation<Pose>& explanation) {
  estimate.update(explanation.accepted, explanation.scale, 10);
  return objective.fit(explanation, objective.stated(), estimate,
                       objective.near({estimate.poses()})) +
         objective.log_scale_peak(explanation);
}

TYPED_TEST(ObjectiveOf, IsTheMarginalLikelihoodOfTheLoops) {
  using Pose = TypeParam;
  Random random(7);
  const auto made = random_loop_graph<Pose>(random, 15, 6, 1.0, 1e6);
  const auto roles = edge_roles(made.graph);
  const Objective<Pose> objective(made.graph, roles, 20);
  const auto& reduced = objective.stated().reduced;
  const std::size_t loops = reduced.loops.size();
  for (const CovarianceScale scale : {CovarianceScale{1.0, 1.0}, CovarianceScale{3.0, 0.2}}) {
    Estimate<Pose> estimate(reduced);
    Explanation<Pose> none{.accepted = std::vector<bool>(loops, false), .scale = scale};
    none.weights.resize(loops);
    Explanation<Pose> all = none;
    all.accepted.assign(loops, true);
    const double without = evidence_of(objective, estimate, none);
    const double with = evidence_of(objective, estimate, all);
    const auto near = objective.near({estimate.poses()});
    double alternatives = 0.0;
    for (std::size_t k = 0; k < loops; ++k) {
      alternatives += objective.log_alternative(static_cast<Index>(k), near, scale.loops);
    }
    // No loop and every loop are equally likely by the Beta-binomial.
    EXPECT_NEAR(with - without + alternatives, dense_log_likelihood(reduced, scale), 0.05);
  }
}

TYPED_TEST(ObjectiveOf, RisesByWhatALoopGains) {
  using Pose = TypeParam;
  Random random(8);
  const auto made = random_loop_graph<Pose>(random, 15, 6, 1.0, 1e6);
  const auto roles = edge_roles(made.graph);
  const Objective<Pose> objective(made.graph, roles, 20);
  const auto& reduced = objective.stated().reduced;
  const std::size_t loops = reduced.loops.size();
  Explanation<Pose> all{.accepted = std::vector<bool>(loops, true)};
  all.weights.resize(loops);
  Explanation<Pose> but_first = all;
  but_first.accepted[0] = false;
  Estimate<Pose> estimate(reduced);
  const auto& link = reduced.loops[0];
  const std::vector<const Link<Pose>*> first = {&link};

  const double without = evidence_of(objective, estimate, but_first);
  const auto belief = [&] {
    return Belief<Pose>{estimate.residual(link), estimate.residual_covariances(first)[0]};
  };
  const auto others = belief();
  const double with = evidence_of(objective, estimate, all);
  const auto held_out = isotherm::slam::detail::without<Pose>(belief(), link.information);
  const ScaleMixture as_most = expected_mixture(1.0, {{1e12, 0.0, 0.0}});
  const OwnError<Pose> own{link.covariance, link.covariance};
  const double gain = loop_gain<Pose>(others, own, as_most).log_density;
  EXPECT_NEAR(loop_gain<Pose>(held_out, own, as_most).log_density, gain, 0.05);

  const auto near = objective.near({estimate.poses()});
  // All of n against a given n - 1 of n by the Beta-binomial: n to 1.
  const double prior = std::log(static_cast<double>(loops));
  EXPECT_NEAR(with - without, gain - objective.log_alternative(0, near, 1.0) + prior, 0.3)
      << "chance on the map with the loop, and on the one without";
}

// What is as accurate as the file says is no wrong measurement, however accurate others are found;
// nor is it a sign that poses are near that a measurement is wild.
TYPED_TEST(ObjectiveOf, TakesOnlyWhatIsOffForWrong) {
  using Pose = TypeParam;
  Random random(9);
  const auto made = random_loop_graph<Pose>(random, 30, 10, 1.0);
  const Objective<Pose> objective(made.graph, edge_roles(made.graph), 20);
  const auto& stated = objective.stated();
  const auto near = objective.near({stated.reduced.poses});
  const auto log_place = [&](double deviations, double scale) {
    Explanation<Pose> now;
    now.scale.loops = scale;
    const auto& covariance = stated.reduced.loops[0].covariance;
    const typename Pose::Matrix root = Eigen::LLT<typename Pose::Matrix>(covariance).matrixL();
    const Belief<Pose> belief{deviations * root.col(0), Pose::Matrix::Zero()};
    return objective.log_place(now, stated, 0, belief, near);
  };
  EXPECT_LT(log_place(1.0, 1.0), -100.0);
  EXPECT_EQ(log_place(1.0, 0.01), log_place(1.0, 1.0));
  EXPECT_LT(log_place(20.0, 100.0), log_place(20.0, 1.0) - 10.0);
  EXPECT_GT(log_place(30.0, 1.0), log_place(1e6, 1.0));
  EXPECT_LT(log_place(1e6, 1.0), -20.0);
}

// Where all loops err as most do that is normal, of its residual under the other.
TYPED_TEST(ObjectiveOf, PredictsALoopByTheOneBeforeIt) {
  using Pose = TypeParam;
  Random random(12);
  const auto made = random_loop_graph<Pose>(random, 30, 40, 1.0);
  const auto roles = edge_roles(made.graph);
  const Objective<Pose> objective(made.graph, roles, 20);
  const auto& graph = objective.stated().reduced;
  const CovarianceScale scale{2.0, 3.0};
  const ScaleMixture as_most = expected_mixture(scale.loops, {{1e12, 0.0, 0.0}});
  std::vector<bool> accepted(graph.loops.size(), false);
  for (std::size_t k = 0; k < 20; ++k) accepted[k] = true;
  const auto found = run_density(objective.runs(), graph, graph, scale, as_most, accepted);
  const auto loops = forward_loops(graph, scale);
  std::size_t led = 0;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const Index before = objective.runs().before(static_cast<Index>(k));
    if (before == Runs<Pose>::kNone || (accepted[k] && accepted[before])) {
      EXPECT_EQ(found[k], 0.0);
      continue;
    }
    ++led;
    const auto [r, S] = pair_residual(graph, scale, loops[before], loops[k]);
    EXPECT_NEAR(found[k], log_normal<Pose>(r, S), 1e-6 * std::abs(found[k])) << k;
  }
  EXPECT_GT(led, 5u);
}

// Without cycles the information of odometry is the determinant of the normal equations.
TYPED_TEST(ObjectiveOf, KnowsTheInformationOfOdometry) {
  using Pose = TypeParam;
  Random random(11);
  const auto made = random_loop_graph<Pose>(random, 30, 10, 1.0);
  auto roles = edge_roles(made.graph);
  for (const bool forest : {true, false}) {
    if (!forest) {
      roles.odometry.push_back(roles.candidates.back());
      roles.candidates.pop_back();
    }
    const auto scaled = scaled_graph(made.graph, roles, {}, Shapes<Pose>());
    EXPECT_EQ(scaled.is_chains(), forest);
    Estimate<Pose> odometry(scaled.reduced);
    odometry.update(std::vector<bool>(scaled.reduced.loops.size(), false), {}, 0);
    const double expected = odometry.log_determinant();
    if (forest) {
      EXPECT_NEAR(scaled.log_information, expected, 1e-9 * std::abs(expected));
    }
    EXPECT_EQ(scaled.variables, odometry.variable_count());
  }
}

// Each coordinate's variances by its factor, of odometry and of loops, and determinants stay.
TYPED_TEST(ObjectiveOf, ScalesEachCoordinate) {
  using Pose = TypeParam;
  Random random(10);
  const auto made = random_loop_graph<Pose>(random, 30, 10, 1.0);
  const auto roles = edge_roles(made.graph);
  Shapes<Pose> shapes;
  shapes.odometry[0] = 5.0;
  shapes.odometry[1] = 0.2;
  shapes.loops[Pose::kDof - 1] = 7.0;
  shapes.loops[0] = 1.0 / 7.0;
  const auto stated = scaled_graph(made.graph, roles, {}, Shapes<Pose>());
  const auto scaled = scaled_graph(made.graph, roles, {}, shapes);
  EXPECT_EQ(scaled.variables, stated.variables);
  const typename Pose::Tangent root = shapes.loops.cwiseSqrt();
  for (std::size_t k = 0; k < stated.reduced.loops.size(); ++k) {
    const typename Pose::Matrix expected =
        root.asDiagonal() * stated.reduced.loops[k].covariance * root.asDiagonal();
    EXPECT_LT((scaled.reduced.loops[k].covariance - expected).norm(), 1e-9 * expected.norm());
  }
  EXPECT_NEAR(rotation_against_translation<Pose>(shapes.loops),
              std::pow(7.0, 1.0 / (Pose::kDof - Pose::kDim) + 1.0 / Pose::kDim), 1e-9);
}

}  // namespace
}  // namespace isotherm::slam::detail
