#include "isotherm/slam/graph/odometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "isotherm_test/random_graphs.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::random_chain;

// Step by step from one end, the definition the block composition must agree with.
template <class Pose>
UncertainPose<Pose> stepwise(const PoseGraph<Pose>& graph, Index from, Index to) {
  UncertainPose<Pose> path;
  for (Index k = from; k < to; ++k) {
    const auto& edge = graph.constraints[k];
    UncertainPose<Pose> step{edge.T_from_to,
                             covariance_from_information<Pose::kDof>(edge.information)};
    if (edge.from > edge.to) step = inverse(step);
    path = compose(path, step);
  }
  return path;
}

template <class Pose>
class OdometryOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(OdometryOf, Poses);

TYPED_TEST(OdometryOf, BlocksAgreeWithSteps) {
  using Pose = TypeParam;
  Random random(5);
  const auto graph = random_chain<Pose>(random, 150);
  const OdometryChain<Pose> chain(graph, edge_roles(graph));
  EXPECT_EQ(chain.chain_count(), 1);
  for (Index from = 0; from < 150; from += 7) {
    for (Index to = from; to < 150; to += 3) {
      const auto expected = stepwise(graph, from, to);
      const auto path = chain.relative(from, to);
      EXPECT_LT((path.T.inverse() * expected.T).log().norm(), 1e-11);
      EXPECT_LT((path.covariance - expected.covariance).norm(),
                1e-9 * (1e-12 + expected.covariance.norm()));
    }
  }
}

TYPED_TEST(OdometryOf, BackwardsIsTheInverse) {
  using Pose = TypeParam;
  Random random(6);
  const auto graph = random_chain<Pose>(random, 40);
  const OdometryChain<Pose> chain(graph, edge_roles(graph));
  const auto forward = chain.relative(3, 37);
  const auto there_and_back = inverse(chain.relative(37, 3));
  EXPECT_LT((forward.T.inverse() * there_and_back.T).log().norm(), 1e-11);
  EXPECT_LT((forward.covariance - there_and_back.covariance).norm(),
            1e-9 * forward.covariance.norm());
}

// The propagated covariance is that of samples, for noise small enough to be linear.
TYPED_TEST(OdometryOf, CovarianceMatchesSampling) {
  using Pose = TypeParam;
  Random random(7);
  auto graph = random_chain<Pose>(random, 8, 1e8);
  const OdometryChain<Pose> chain(graph, edge_roles(graph));
  const auto predicted = chain.relative(0, 7);

  typename Pose::Matrix sum = Pose::Matrix::Zero();
  const int samples = 20000;
  for (int s = 0; s < samples; ++s) {
    Pose end;
    for (const auto& edge : graph.constraints) {
      const auto covariance = covariance_from_information<Pose::kDof>(edge.information);
      const typename Pose::Matrix root = Eigen::LLT<typename Pose::Matrix>(covariance).matrixL();
      const Pose noisy =
          edge.T_from_to * Pose::exp(root * isotherm_test::random_tangent<Pose>(random, 1.0));
      end = end * (edge.from < edge.to ? noisy : noisy.inverse());
    }
    const typename Pose::Tangent xi = (predicted.T.inverse() * end).log();
    sum += xi * xi.transpose();
  }
  const typename Pose::Matrix sampled = sum / samples;
  // Relative standard error of a variance from n samples is sqrt(2/n) = 1 %.
  EXPECT_LT((sampled - predicted.covariance).norm(), 0.06 * predicted.covariance.norm());
}

TYPED_TEST(OdometryOf, GapsSplitChains) {
  using Pose = TypeParam;
  Random random(8);
  auto graph = random_chain<Pose>(random, 50);
  graph.constraints.erase(graph.constraints.begin() + 20);
  const auto roles = edge_roles(graph);
  const OdometryChain<Pose> chain(graph, roles);
  EXPECT_EQ(chain.chain_count(), 2);
  EXPECT_EQ(chain.chain(20), 0);
  EXPECT_EQ(chain.chain(21), 1);
  EXPECT_THROW(chain.relative(20, 21), InvalidArgument);
  EXPECT_THROW(chain.relative(0, 50), InvalidArgument);
  EXPECT_NO_THROW(chain.relative(22, 49));

  const auto poses = odometry_poses(graph, roles);
  EXPECT_EQ(poses[21].translation(), Pose().translation()) << "each chain starts at the identity";
}

TYPED_TEST(OdometryOf, PosesFollowTheSteps) {
  using Pose = TypeParam;
  Random random(9);
  auto graph = random_chain<Pose>(random, 30);
  const auto roles = edge_roles(graph);
  for (const auto& edge : graph.constraints) {
    const auto poses = odometry_poses(graph, roles);
    EXPECT_LT(residual(edge, poses[edge.from], poses[edge.to]).norm(), 1e-12);
  }
  graph.poses.assign(30, Pose::exp(isotherm_test::random_tangent<Pose>(random, 1.0)));
  EXPECT_LT((odometry_poses(graph, roles).front().inverse() * graph.poses.front()).log().norm(),
            1e-15)
      << "the first pose is the file's";
}

TYPED_TEST(OdometryOf, EmptyAndSingle) {
  using Pose = TypeParam;
  PoseGraph<Pose> graph;
  EXPECT_EQ(OdometryChain<Pose>(graph, edge_roles(graph)).chain_count(), 0);
  EXPECT_TRUE(odometry_poses(graph, edge_roles(graph)).empty());
  graph.ids = {5};
  const OdometryChain<Pose> chain(graph, edge_roles(graph));
  EXPECT_EQ(chain.chain_count(), 1);
  EXPECT_EQ(chain.relative(0, 0).covariance, Pose::Matrix::Zero());
}

}  // namespace
}  // namespace isotherm::slam
