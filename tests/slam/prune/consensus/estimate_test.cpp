#include "prune/consensus/estimate/estimate.hpp"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "isotherm/slam/optimize/optimize.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;

// Covariance of T_a^-1 T_b from the dense normal equations of the whole graph,
// with derivatives by finite differences: nothing is shared with the sparse code.
template <class Pose>
class DenseOracle {
 public:
  DenseOracle(const PoseGraph<Pose>& graph, const std::vector<Pose>& poses) : poses_(poses) {
    const auto size = static_cast<Eigen::Index>(poses.size()) * Pose::kDof;
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
    for (const auto& constraint : graph.constraints) {
      const auto derivative = jacobian(
          constraint.from, constraint.to,
          [&](const Pose& from, const Pose& to) { return residual(constraint, from, to); });
      hessian += derivative.transpose() * constraint.information * derivative;
    }
    hessian.topLeftCorner<Pose::kDof, Pose::kDof>().diagonal().array() += 1e10;  // the gauge
    covariance_ = hessian.inverse();
  }

  typename Pose::Matrix relative(Index a, Index b) const {
    const Pose predicted = poses_[a].inverse() * poses_[b];
    const auto derivative = jacobian(a, b, [&](const Pose& from, const Pose& to) {
      return (predicted.inverse() * (from.inverse() * to)).log();
    });
    return derivative * covariance_ * derivative.transpose();
  }

 private:
  template <class Function>
  Eigen::MatrixXd jacobian(Index a, Index b, Function function) const {
    constexpr double kStep = 1e-6;
    Eigen::MatrixXd result =
        Eigen::MatrixXd::Zero(Pose::kDof, static_cast<Eigen::Index>(poses_.size()) * Pose::kDof);
    for (int d = 0; d < Pose::kDof; ++d) {
      const typename Pose::Tangent xi = kStep * Pose::Tangent::Unit(d);
      const Pose forth = Pose::exp(xi);
      const Pose back = Pose::exp(-xi);
      result.col(a * Pose::kDof + d) =
          (function(poses_[a] * forth, poses_[b]) - function(poses_[a] * back, poses_[b])) /
          (2.0 * kStep);
      result.col(b * Pose::kDof + d) =
          (function(poses_[a], poses_[b] * forth) - function(poses_[a], poses_[b] * back)) /
          (2.0 * kStep);
    }
    return result;
  }

  const std::vector<Pose>& poses_;
  Eigen::MatrixXd covariance_;
};

template <class Pose>
class EstimateOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(EstimateOf, Poses);

TYPED_TEST(EstimateOf, ContractionKeepsTheOptimum) {
  using Pose = TypeParam;
  Random random(11);
  const auto made = random_loop_graph<Pose>(random, 60, 8, 0.1, 1e6);
  const auto reduced = reduce(made.graph, edge_roles(made.graph));
  EXPECT_LE(reduced.node_count(), 16);
  EXPECT_EQ(reduced.steps.size() + 1, reduced.vertex.size());

  Estimate<Pose> estimate(reduced);
  estimate.update(std::vector<bool>(reduced.loops.size(), true), {}, 10);
  const auto whole = optimize(made.graph);
  const auto& poses = estimate.poses();
  for (std::size_t a = 1; a < poses.size(); ++a) {
    const Pose expected = whole.poses[reduced.vertex[0]].inverse() * whole.poses[reduced.vertex[a]];
    EXPECT_LT((expected.inverse() * (poses[0].inverse() * poses[a])).log().norm(), 1e-6);
  }
}

TYPED_TEST(EstimateOf, DrawsMapsOfTheCovarianceThatPosesHave) {
  using Pose = TypeParam;
  using Matrix = typename Pose::Matrix;
  constexpr std::size_t kDraws = 4000;
  Random random(18);
  const auto made = random_loop_graph<Pose>(random, 30, 4, 1.0, 1e6);
  const auto reduced = reduce(made.graph, edge_roles(made.graph));
  Estimate<Pose> estimate(reduced);
  std::vector<bool> accepted(reduced.loops.size(), true);
  accepted[2] = false;
  const CovarianceScale scale{3.0, 0.5};
  estimate.update(accepted, scale, 10);
  const auto& loop = reduced.loops[2];
  const auto& poses = estimate.poses();
  const Pose expected = poses[loop.a].inverse() * poses[loop.b];
  Matrix drawn = Matrix::Zero();
  const Eigen::MatrixXd all = estimate.drawn(scale, kDraws);
  for (const auto& moves : all.colwise()) {
    const auto map = estimate.moved(moves);
    const auto off = (expected.inverse() * (map[loop.a].inverse() * map[loop.b])).log().eval();
    drawn += off * off.transpose() / static_cast<double>(kDraws);
  }
  const std::vector<const Link<Pose>*> link = {&loop};
  const auto J = residual_jacobian<Pose>(estimate.residual(loop));
  const Matrix known =
      J.inverse() * estimate.residual_covariances(link)[0] * J.inverse().transpose();
  EXPECT_LT((drawn - known).norm(), 0.1 * known.norm());
}

// Though the end of the chain may lie anywhere, no step is off by more than it errs.
TYPED_TEST(EstimateOf, DrawsMapsThatTearNoStepApart) {
  using Pose = TypeParam;
  Random random(20);
  const auto made = random_loop_graph<Pose>(random, 400, 60, 0.0, 100.0);
  const auto reduced = reduce(made.graph, edge_roles(made.graph));
  Estimate<Pose> estimate(reduced);
  estimate.update(std::vector<bool>(reduced.loops.size()), {}, 10);
  const auto map = estimate.moved(estimate.drawn({}, 1));
  double chi2 = 0.0;
  for (const auto& step : reduced.steps) {
    const auto r = step.T_a_b.between(map[step.a].between(map[step.b])).log().eval();
    chi2 += r.dot(step.information * r);
  }
  EXPECT_NEAR(chi2 / static_cast<double>(Pose::kDof * reduced.steps.size()), 1.0, 0.2);
}

// What one loop says is all that is new, whichever loops there are.
TYPED_TEST(EstimateOf, DrawsMapsThatChangeLittleWithALoop) {
  using Pose = TypeParam;
  Random random(19);
  const auto made = random_loop_graph<Pose>(random, 60, 20, 1.0, 1e6);
  auto reduced = reduce(made.graph, edge_roles(made.graph));
  reduced.loops[3].information *= 1e-9;
  Estimate<Pose> estimate(reduced);
  std::vector<bool> accepted(reduced.loops.size(), true);
  estimate.update(accepted, {}, 10);
  const auto with = estimate.moved(estimate.drawn({}, 1));
  accepted[3] = false;
  estimate.update(accepted, {}, 10);
  const auto without = estimate.moved(estimate.drawn({}, 1));
  for (std::size_t v = 0; v < with.size(); ++v) {
    EXPECT_LT((without[v].inverse() * with[v]).log().norm(), 1e-4);
  }
}

TYPED_TEST(EstimateOf, CovariancesAreThoseOfTheWholeGraph) {
  using Pose = TypeParam;
  Random random(12);
  auto made = random_loop_graph<Pose>(random, 40, 8, 0.0, 1e6);
  const auto roles = edge_roles(made.graph);
  const auto reduced = reduce(made.graph, roles);
  std::vector<bool> accepted(reduced.loops.size(), true);
  accepted[1] = accepted[4] = false;
  Estimate<Pose> estimate(reduced);
  estimate.update(accepted, {}, 3);

  auto keep = std::vector<bool>(made.graph.constraints.size(), true);
  keep[roles.candidates[1]] = keep[roles.candidates[4]] = false;
  const DenseOracle<Pose> oracle(filter_constraints(made.graph, keep), made.truth);
  std::vector<const Link<Pose>*> all;
  for (const auto& loop : reduced.loops) all.push_back(&loop);
  const auto covariances = estimate.residual_covariances(all);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto& loop = reduced.loops[k];
    const auto J = residual_jacobian<Pose>(estimate.residual(loop));
    const typename Pose::Matrix expected =
        J * oracle.relative(reduced.vertex[loop.a], reduced.vertex[loop.b]) * J.transpose();
    EXPECT_LT((covariances[k] - expected).norm(), 1e-4 * expected.norm());
  }
}

// However the ends of a link are correlated.
TYPED_TEST(EstimateOf, BoundsAreNoLessThanCovariances) {
  using Pose = TypeParam;
  Random random(18);
  const auto made = random_loop_graph<Pose>(random, 60, 20, 1.0, 1e4);
  const auto reduced = reduce(made.graph, edge_roles(made.graph));
  std::vector<bool> accepted(reduced.loops.size(), true);
  accepted[2] = accepted[5] = false;
  Estimate<Pose> estimate(reduced);
  estimate.update(accepted, {}, 10);
  typename Estimate<Pose>::Links steps;
  typename Estimate<Pose>::Links loops;
  for (const auto& step : reduced.steps) steps.push_back(&step);
  for (const auto& loop : reduced.loops) loops.push_back(&loop);
  const auto exact = estimate.residual_covariances(loops);
  const auto of_steps = estimate.residual_covariances(steps);
  const auto both = estimate.residual_covariances(steps, 1, loops);
  for (std::size_t k = 0; k < steps.size(); ++k) EXPECT_EQ(both[k], of_steps[k]);
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const typename Pose::Matrix more = both[steps.size() + k] - exact[k];
    const Eigen::SelfAdjointEigenSolver<typename Pose::Matrix> axes(more);
    EXPECT_GT(axes.eigenvalues().minCoeff(), -1e-9 * exact[k].norm()) << k;
  }
}

TYPED_TEST(EstimateOf, LoopsMovePartsTogether) {
  using Pose = TypeParam;
  Random random(13);
  auto made = random_loop_graph<Pose>(random, 30, 4, 0.0);
  made.graph.constraints.erase(made.graph.constraints.begin() + 14);  // two chains
  Constraint<Pose> bridge;
  bridge.from = 3;
  bridge.to = 27;
  bridge.T_from_to = made.truth[3].inverse() * made.truth[27];
  made.graph.constraints.push_back(bridge);
  const auto reduced = reduce(made.graph, edge_roles(made.graph));
  Estimate<Pose> estimate(reduced);
  std::vector<bool> accepted(reduced.loops.size(), false);
  estimate.update(accepted, {}, 3);
  const auto [first, second] = estimate.parts(reduced.loops.back());
  EXPECT_NE(first, second);

  accepted.back() = true;
  estimate.update(accepted, {}, 3);
  for (const auto& loop : reduced.loops) EXPECT_LT(estimate.residual(loop).norm(), 1e-9);
}

// Poses turned at random, of two chains that no loop joins.
TYPED_TEST(EstimateOf, IsLaidOutAnewWhereverPosesAre) {
  using Pose = TypeParam;
  Random random(17);
  auto made = random_loop_graph<Pose>(random, 40, 12, 1.0, 1e4);
  std::erase_if(made.graph.constraints,
                [](const auto& edge) { return (edge.from < 20) != (edge.to < 20); });
  const auto reduced = reduce(made.graph, edge_roles(made.graph));
  const std::vector<bool> accepted(reduced.loops.size(), true);
  const CovarianceScale scale{2.0, 0.5};
  Estimate<Pose> estimate(reduced);
  estimate.update(accepted, scale, 20);
  Estimate<Pose> turned(reduced);
  auto layout = estimate.layout();
  for (Pose& pose : layout.poses)
    pose = pose * Pose::exp(random.normal_vector<typename Pose::Tangent>());
  turned.restore(layout);
  turned.lay_out_anew(accepted, scale);
  turned.update(accepted, scale, 20);
  ASSERT_FALSE(reduced.loops.empty());
  for (const auto& loop : reduced.loops) {
    EXPECT_LT((turned.residual(loop) - estimate.residual(loop)).norm(), 1e-6);
  }
  EXPECT_EQ(turned.layout().component, estimate.layout().component);
  EXPECT_FALSE(turned.differs_from(estimate.layout(), scale));
  EXPECT_TRUE(turned.differs_from(layout, scale));
}

// Where the loops stay the same, only values are computed anew.
TYPED_TEST(EstimateOf, CovariancesFollowTheScaleAndWhatIsTakenBack) {
  using Pose = TypeParam;
  Random random(15);
  const auto made = random_loop_graph<Pose>(random, 40, 8, 0.1, 1e6);
  const auto reduced = reduce(made.graph, edge_roles(made.graph));
  const std::vector<const Link<Pose>*> asked = {&reduced.loops[0], &reduced.loops[3],
                                                &reduced.loops[7]};
  Estimate<Pose> estimate(reduced);
  const auto covariances = [&](const std::vector<bool>& accepted, const CovarianceScale& scale) {
    estimate.update(accepted, scale, 20);
    return estimate.residual_covariances(asked);
  };
  std::vector<bool> few(reduced.loops.size(), false);
  few[2] = few[5] = true;
  const auto before = covariances(few, {1.0, 1.0});
  const auto layout = estimate.layout();
  const auto doubled = covariances(few, {2.0, 2.0});
  covariances(std::vector<bool>(reduced.loops.size(), true), {1.0, 1.0});
  estimate.restore(layout);
  const auto after = covariances(few, {1.0, 1.0});
  for (std::size_t k = 0; k < asked.size(); ++k) {
    EXPECT_LT((doubled[k] - 2.0 * before[k]).norm(), 1e-6 * before[k].norm());
    EXPECT_LT((after[k] - before[k]).norm(), 1e-6 * before[k].norm());
  }
}

TYPED_TEST(EstimateOf, TrustedEdgesBesideTheChainAreUsed) {
  using Pose = TypeParam;
  Random random(14);
  const auto made = random_loop_graph<Pose>(random, 30, 5, 0.0);
  auto roles = edge_roles(made.graph);
  roles.odometry.push_back(roles.candidates.back());
  roles.candidates.pop_back();
  const auto reduced = reduce(made.graph, roles);
  EXPECT_EQ(reduced.loops.size(), 4u);
  EXPECT_EQ(reduced.steps.size(), reduced.vertex.size());
}

}  // namespace
}  // namespace isotherm::slam::detail
