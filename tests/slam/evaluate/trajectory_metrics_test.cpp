#include "isotherm/slam/evaluate/trajectory_metrics.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm_test/random_graphs.hpp"

namespace isotherm::slam {
namespace {

template <class Pose>
class TrajectoryMetrics : public testing::Test {
 protected:
  PosePairs<Pose> random_pairs(int n, double noise) {
    PosePairs<Pose> pairs;
    Pose pose;
    for (int k = 0; k < n; ++k) {
      pose = pose * Pose::exp(isotherm_test::random_tangent<Pose>(random, 1.0));
      pairs.truth.push_back(pose);
      pairs.estimate.push_back(pose *
                               Pose::exp(isotherm_test::random_tangent<Pose>(random, noise)));
    }
    return pairs;
  }

  Random random{41};
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(TrajectoryMetrics, Poses);

TYPED_TEST(TrajectoryMetrics, AlignmentUndoesARigidMotion) {
  using Pose = TypeParam;
  auto pairs = this->random_pairs(30, 0.0);
  const Pose moved = Pose::exp(isotherm_test::random_tangent<Pose>(this->random, 3.0));
  for (auto& pose : pairs.estimate) pose = moved * pose;
  for (const auto alignment : {Alignment::first, Alignment::se}) {
    EXPECT_LT(absolute_trajectory_error(pairs, alignment).max, 1e-12);
    EXPECT_LT((align(pairs, alignment) * moved).log().norm(), 1e-12);
  }
  EXPECT_GT(absolute_trajectory_error(pairs, Alignment::none).max, 0.1);
  EXPECT_LT(relative_pose_error(pairs).translation.max, 1e-12);
}

TYPED_TEST(TrajectoryMetrics, NoMotionNearTheLeastSquaresOneIsBetter) {
  using Pose = TypeParam;
  auto pairs = this->random_pairs(25, 0.3);
  const double best = absolute_trajectory_error(pairs, Alignment::se).rmse;
  const Pose T = align(pairs, Alignment::se);
  for (int trial = 0; trial < 50; ++trial) {
    auto moved = pairs;
    const Pose nearby = T * Pose::exp(isotherm_test::random_tangent<Pose>(this->random, 0.02));
    for (auto& pose : moved.estimate) pose = nearby * pose;
    EXPECT_GE(absolute_trajectory_error(moved, Alignment::none).rmse, best);
  }
  EXPECT_LE(best, absolute_trajectory_error(pairs, Alignment::first).rmse);
}

TYPED_TEST(TrajectoryMetrics, FirstMakesTheFirstPosesEqual) {
  auto pairs = this->random_pairs(10, 0.5);
  const auto T = align(pairs, Alignment::first);
  EXPECT_LT(((T * pairs.estimate[0]).inverse() * pairs.truth[0]).log().norm(), 1e-13);
  EXPECT_LT(absolute_trajectory_error(pairs, Alignment::first).min, 1e-13);
}

TYPED_TEST(TrajectoryMetrics, RelativeErrorSeesOneBadStep) {
  using Pose = TypeParam;
  auto pairs = this->random_pairs(21, 0.0);
  typename Pose::Tangent jump = Pose::Tangent::Zero();
  jump[0] = 0.7;
  jump[Pose::kDof - 1] = 0.2;
  // The jump happens in the motion from pose 9 to pose 10.
  const Pose wrong = pairs.truth[9] * Pose::exp(jump) * pairs.truth[9].inverse();
  for (std::size_t k = 10; k < 21; ++k) pairs.estimate[k] = wrong * pairs.estimate[k];
  const auto steps = relative_pose_error(pairs);
  EXPECT_EQ(steps.translation.pairs, 20);
  EXPECT_NEAR(steps.rotation.max, 0.2, 1e-12);
  EXPECT_NEAR(steps.rotation.mean, 0.2 / 20, 1e-12);
  EXPECT_LT(steps.translation.median, 1e-12);
  EXPECT_EQ(relative_pose_error(pairs, {.delta = 5}).rotation.pairs, 4);
  EXPECT_EQ(relative_pose_error(pairs, {.delta = 5, .all_pairs = true}).rotation.pairs, 16);
  EXPECT_NEAR(relative_pose_error(pairs, {.delta = 5, .all_pairs = true}).rotation.mean,
              5 * 0.2 / 16, 1e-12);
  EXPECT_EQ(relative_pose_error(pairs, {.delta = 30}).rotation.pairs, 0);
  EXPECT_THROW(relative_pose_error(pairs, {.delta = 0}), InvalidArgument);
}

TYPED_TEST(TrajectoryMetrics, DegenerateInput) {
  using Pose = TypeParam;
  PosePairs<Pose> none;
  EXPECT_THROW(absolute_trajectory_error(none, Alignment::none), InvalidArgument);
  EXPECT_EQ(relative_pose_error(none).translation.pairs, 0);
  PosePairs<Pose> one = this->random_pairs(1, 0.5);
  EXPECT_LT(absolute_trajectory_error(one, Alignment::first).max, 1e-14);
  EXPECT_THROW(absolute_trajectory_error(one, Alignment::se), InvalidArgument);
}

TYPED_TEST(TrajectoryMetrics, PosesWithoutTruthAreLeftOut) {
  using Pose = TypeParam;
  const auto pairs = this->random_pairs(4, 0.1);
  std::vector<std::optional<Pose>> truth(pairs.truth.begin(), pairs.truth.end());
  truth[1].reset();
  const auto fewer = pair_poses(pairs.estimate, truth);
  EXPECT_EQ(fewer.estimate.size(), 3u);
  EXPECT_EQ(fewer.truth[1].translation(), pairs.truth[2].translation());
  truth.pop_back();
  EXPECT_THROW(pair_poses(pairs.estimate, truth), InvalidArgument);
}

TEST(PairTrajectories, NearestInTimeWithinTheLimit) {
  Trajectory<Pose2> truth;
  for (int k = 0; k < 10; ++k) {
    truth.timestamps.push_back(k);
    truth.poses.emplace_back(k, 0.0, 0.0);
  }
  Trajectory<Pose2> estimate;
  estimate.timestamps = {0.004, 1.5, 2.995, 20.0};
  estimate.poses.resize(4);
  const auto pairs = pair_trajectories(estimate, truth);
  ASSERT_EQ(pairs.truth.size(), 2u);
  EXPECT_EQ(pairs.truth[0].translation().x(), 0.0);
  EXPECT_EQ(pairs.truth[1].translation().x(), 3.0);
  EXPECT_EQ(pair_trajectories(estimate, truth, 0.6).truth.size(), 3u);
  estimate.timestamps.clear();
  EXPECT_THROW(pair_trajectories(estimate, truth), InvalidArgument);
  truth.timestamps.clear();
  EXPECT_THROW(pair_trajectories(estimate, truth), InvalidArgument) << "lengths differ";
}

TEST(Summarize, OfKnownNumbers) {
  const auto even = summarize({3.0, 1.0, 2.0, 6.0});
  EXPECT_EQ(even.pairs, 4);
  EXPECT_DOUBLE_EQ(even.mean, 3.0);
  EXPECT_DOUBLE_EQ(even.median, 2.5);
  EXPECT_DOUBLE_EQ(even.rmse, std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(even.std, std::sqrt(3.5));
  EXPECT_EQ(even.max, 6.0);
  EXPECT_EQ(even.min, 1.0);
  EXPECT_EQ(summarize({5.0, 1.0, 2.0}).median, 2.0);
  EXPECT_EQ(summarize({}).pairs, 0);
}

}  // namespace
}  // namespace isotherm::slam
