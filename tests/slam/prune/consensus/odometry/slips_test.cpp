#include "prune/consensus/odometry/slip_changes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "prune/consensus/climb/assessment.hpp"
#include "slam/loop_graph.hpp"
#include "slam/prune/consensus/all_accepted.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::AllAccepted;
using isotherm_test::random_loop_graph;

// Of three edges, however many slip: each number of slips is as likely as the next.
TEST(Slips, AreAsLikelyAsTheirShareMayBe) {
  double sum = 0.0;
  for (std::uint8_t a = 0; a < kSlipSizes; ++a) {
    for (std::uint8_t b = 0; b < kSlipSizes; ++b) {
      for (std::uint8_t c = 0; c < kSlipSizes; ++c) sum += std::exp(log_prior_of({a, b, c}));
    }
  }
  EXPECT_NEAR(sum, 4.0, 1e-12);
  EXPECT_EQ(log_prior_of({}), 0.0);
  EXPECT_NEAR(log_prior_of({0, 0, 0}), 0.0, 1e-12);
}

TEST(Slips, HaveTheOddsOfOneMore) {
  const Slips before = {0, 2, 0, 0, 1, 0};
  const auto odds = log_slip_odds(before, before.size());
  EXPECT_EQ(odds[0], 0.0);
  for (std::uint8_t slip = 1; slip < kSlipSizes; ++slip) {
    Slips after = before;
    after[3] = slip;
    EXPECT_NEAR(odds[slip], log_prior_of(after) - log_prior_of(before), 1e-12);
  }
  EXPECT_TRUE(std::isfinite(log_slip_odds({1}, 1)[1]));
  EXPECT_TRUE(std::isfinite(log_slip_odds({}, 0)[1]));
}

template <class Pose>
class SlippedEdgeOf : public testing::Test {
 protected:
  using Matrix = typename Pose::Matrix;
  using Tangent = typename Pose::Tangent;

  SlippedEdgeOf() {
    Random random(6);
    const Matrix L = Matrix::NullaryExpr([&] { return random.normal(); });
    Sigma_ = L * L.transpose() + 0.1 * Matrix::Identity();
    edge_.motion = Tangent::NullaryExpr([&] { return std::exp(random.normal()); });
  }

  ChainEdge<Pose> edge_{};
  Matrix Sigma_;
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(SlippedEdgeOf, Poses);

// The mean of exp(-e' S^-1 e / 2) over errors of covariance P is |I + P S^-1|^(-1/2).
TYPED_TEST(SlippedEdgeOf, MovesAsRobotsDo) {
  constexpr double kScale = 3.0;
  using Square = typename TypeParam::Matrix;
  const Square S = this->edge_.motion.asDiagonal();
  for (std::size_t slip = 1; slip < kSlipSizes; ++slip) {
    const auto found = slipped<TypeParam>(this->edge_, this->Sigma_, slip, kScale);
    const Square P = kScale * slip_factor(slip) * this->Sigma_;
    const Square both = (P.inverse() + S.inverse()).inverse();
    EXPECT_LT((kScale * found.covariance - both).norm(), 1e-9 * both.norm());
    const Square spread = Square::Identity() + P * S.inverse();
    EXPECT_NEAR(found.log_motion, -0.5 * std::log(spread.determinant()), 1e-9);
  }
}

TYPED_TEST(SlippedEdgeOf, IsAsToldWhereItDoesNotOrNothingIsKnownOfMotion) {
  const auto none = slipped<TypeParam>(this->edge_, this->Sigma_, 0, 2.0);
  EXPECT_EQ(none.covariance, this->Sigma_);
  EXPECT_EQ(none.log_motion, 0.0);
  this->edge_.motion.setConstant(std::numeric_limits<double>::infinity());
  const auto anyhow = slipped<TypeParam>(this->edge_, this->Sigma_, 2, 2.0);
  EXPECT_LT((anyhow.covariance / slip_factor(2) - this->Sigma_).norm(), 1e-9 * this->Sigma_.norm());
  EXPECT_NEAR(anyhow.log_motion, 0.0, 1e-9);
}

// A step that is told to be long may have been: of the others the root mean square, of a robot that
// never turns nothing.
TEST(Chain, KnowsHowRobotsMove) {
  PoseGraph<Pose2> graph;
  graph.ids = {0, 1, 2, 3};
  for (const auto& [from, length] : {std::pair{0, 1.0}, {1, 2.0}, {2, 7.0}}) {
    graph.constraints.push_back(
        {from, from + 1, Pose2(length, 0.0, 0.0), Eigen::Matrix3d::Identity()});
  }
  const auto chain = chain_of(graph, edge_roles(graph));
  ASSERT_EQ(chain.size(), 3U);
  EXPECT_NEAR(chain[0]->motion[0], 18.0, 1e-12);
  EXPECT_NEAR(chain[1]->motion[1], 18.0, 1e-12);
  EXPECT_NEAR(chain[2]->motion[0], 49.0, 1e-12);
  EXPECT_TRUE(std::isinf(chain[0]->motion[2]));
}

template <class Pose>
class SlipChangesOf : public testing::Test {
 protected:
  static constexpr Index kSlipped = 21;

  // Chains of a few edges between the ends of loops, one of which errs by so many deviations.
  SlipChangesOf() {
    Random random(5);
    graph_ = random_loop_graph<Pose>(random, 40, 14, 1.0, 1e12).graph;
    auto& step = graph_.constraints[kSlipped];
    EXPECT_EQ(step.to, kSlipped + 1);
    step.T_from_to = step.T_from_to * Pose::exp(30e-6 * Pose::Tangent::Ones());
  }

  static double evidence(const Objective<Pose>& objective, const Slips& slips) {
    return AllAccepted<Pose>(objective, {}, {.slips = slips}).evidence();
  }

  static std::vector<SlipChange> changes(const Objective<Pose>& objective, const Slips& slips) {
    const AllAccepted<Pose> all(objective, {}, {.slips = slips});
    return objective.slip_changes(all.explanation(), all.graph(), all.steps());
  }

  PoseGraph<Pose> graph_;
};

TYPED_TEST_SUITE(SlipChangesOf, Poses);

TYPED_TEST(SlipChangesOf, GainWhatTheEvidenceDoes) {
  using Pose = TypeParam;
  const Objective<Pose> objective(this->graph_, edge_roles(this->graph_), 20);
  const Slips none(objective.odometry_edges());
  const auto found = this->changes(objective, none);
  ASSERT_FALSE(found.empty());
  for (const SlipChange& change : found) {
    Slips slips = none;
    slips[static_cast<std::size_t>(change.vertex)] = change.slip;
    const double gain = this->evidence(objective, slips) - this->evidence(objective, none);
    EXPECT_NEAR(change.gain, gain, 1e-3 * std::abs(gain) + 0.1) << change.vertex;
  }
}

TYPED_TEST(SlipChangesOf, TakeBackWhatNeedNotSlip) {
  using Pose = TypeParam;
  const Objective<Pose> objective(this->graph_, edge_roles(this->graph_), 20);
  Slips slips(objective.odometry_edges());
  slips[this->kSlipped] = 2;
  EXPECT_TRUE(std::ranges::all_of(this->changes(objective, slips),
                                  [](const auto& change) { return change.slip == 0; }));
}

TYPED_TEST(SlipChangesOf, NothingWhereNothingIsKnown) {
  using Pose = TypeParam;
  const Objective<Pose> objective(this->graph_, edge_roles(this->graph_), 20);
  Explanation<Pose> none{.accepted = std::vector<bool>(14, false)};
  none.weights.resize(none.accepted.size());
  Assessment<Pose> assessment(objective);
  assessment.assess(none);
  EXPECT_TRUE(assessment.slip_changes(none).empty());
}

}  // namespace
}  // namespace isotherm::slam::detail
