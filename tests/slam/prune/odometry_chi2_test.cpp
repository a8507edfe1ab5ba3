#include "isotherm/slam/prune/odometry_chi2.hpp"

#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm_test/random_graphs.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::random_chain;

// Cost at the optimum of odometry plus one loop, by one dense Gauss-Newton step
// from the odometry solution on all poses but the first.
template <class Pose>
double dense_chi2(const PoseGraph<Pose>& graph, const std::vector<Pose>& poses, Index loop) {
  constexpr int d = Pose::kDof;
  const auto unknowns = d * static_cast<Eigen::Index>(poses.size() - 1);
  std::vector<Index> used(poses.size() - 1);
  for (std::size_t k = 0; k < used.size(); ++k) used[k] = static_cast<Index>(k);
  used.push_back(loop);

  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(d * used.size(), unknowns);
  Eigen::VectorXd rhs(d * used.size());
  for (std::size_t row = 0; row < used.size(); ++row) {
    const auto& edge = graph.constraints[used[row]];
    const typename Pose::Matrix whiten =
        Eigen::LLT<typename Pose::Matrix>(edge.information).matrixU();
    rhs.segment<d>(d * row) = whiten * residual(edge, poses[edge.from], poses[edge.to]);
    for (const Index vertex : {edge.from, edge.to}) {
      if (vertex == 0) continue;
      for (int k = 0; k < d; ++k) {
        const double h = 1e-6;
        typename Pose::Tangent step = Pose::Tangent::Zero();
        step[k] = h;
        auto plus = poses;
        auto minus = poses;
        plus[vertex] = plus[vertex] * Pose::exp(step);
        minus[vertex] = minus[vertex] * Pose::exp(-step);
        jacobian.block<d, 1>(d * row, d * (vertex - 1) + k) =
            whiten *
            (residual(edge, plus[edge.from], plus[edge.to]) -
             residual(edge, minus[edge.from], minus[edge.to])) /
            (2 * h);
      }
    }
  }
  const Eigen::VectorXd step = jacobian.colPivHouseholderQr().solve(-rhs);
  return (rhs + jacobian * step).squaredNorm();
}

template <class Pose>
Constraint<Pose> noisy_loop(const std::vector<Pose>& poses, Index from, Index to, double sigma,
                            Random& random) {
  Constraint<Pose> loop;
  loop.from = from;
  loop.to = to;
  loop.T_from_to = poses[from].inverse() * poses[to] *
                   Pose::exp(isotherm_test::random_tangent<Pose>(random, sigma));
  loop.information = isotherm_test::random_information<Pose>(random, 1e3);
  return loop;
}

template <class Pose>
class OdometryChi2Of : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(OdometryChi2Of, Poses);

TYPED_TEST(OdometryChi2Of, EqualsTheLinearisedOptimumWithFullInformation) {
  using Pose = TypeParam;
  Random random(21);
  auto graph = random_chain<Pose>(random, 12);
  auto poses = odometry_poses(graph, edge_roles(graph));
  for (const auto& [from, to] : {std::pair<Index, Index>{1, 9}, {11, 2}, {0, 11}, {4, 6}}) {
    auto with_loop = graph;
    with_loop.constraints.push_back(noisy_loop<Pose>(poses, from, to, 0.05, random));
    const auto result = odometry_chi2(with_loop, edge_roles(with_loop));
    ASSERT_EQ(result.size(), 1u);
    const double expected = dense_chi2(with_loop, poses, 11);
    EXPECT_NEAR(result[0].chi2, expected, 1e-6 * (1 + expected));
    EXPECT_TRUE(result[0].connected);
  }
}

TYPED_TEST(OdometryChi2Of, FollowsChiSquaredUnderTheModel) {
  using Pose = TypeParam;
  Random random(22);
  const auto clean = random_chain<Pose>(random, 60, 1e8);
  const auto truth = odometry_poses(clean, edge_roles(clean));
  int above_median = 0;
  const int trials = 400;
  for (int trial = 0; trial < trials; ++trial) {
    auto graph = clean;
    for (auto& edge : graph.constraints) {
      const typename Pose::Matrix root =
          Eigen::LLT<typename Pose::Matrix>(edge.information.inverse().eval()).matrixL();
      edge.T_from_to =
          edge.T_from_to * Pose::exp(root * isotherm_test::random_tangent<Pose>(random, 1.0));
    }
    auto loop = noisy_loop<Pose>(truth, 10, 50, 0.0, random);
    loop.information = 1e8 * Pose::Matrix::Identity();
    loop.T_from_to = loop.T_from_to * Pose::exp(isotherm_test::random_tangent<Pose>(random, 1e-4));
    graph.constraints.push_back(loop);
    const double chi2 = odometry_chi2(graph, edge_roles(graph))[0].chi2;
    if (chi2 > chi_squared_quantile(0.5, Pose::kDof)) ++above_median;
  }
  // Binomial standard deviation is 10.
  EXPECT_NEAR(above_median, trials / 2, 50);
}

TYPED_TEST(OdometryChi2Of, DisconnectedEndsCannotDisagree) {
  using Pose = TypeParam;
  Random random(23);
  auto graph = random_chain<Pose>(random, 10);
  const auto poses = odometry_poses(graph, edge_roles(graph));
  const auto loop = noisy_loop<Pose>(poses, 1, 8, 5.0, random);
  graph.constraints.erase(graph.constraints.begin() + 4);
  graph.constraints.push_back(loop);
  const auto result = odometry_chi2(graph, edge_roles(graph));
  EXPECT_FALSE(result[0].connected);
  EXPECT_EQ(result[0].chi2, 0.0);
}

TYPED_TEST(OdometryChi2Of, LoopToItselfIsComparedWithTheIdentity) {
  using Pose = TypeParam;
  Random random(24);
  auto graph = random_chain<Pose>(random, 5);
  Constraint<Pose> self;
  self.from = self.to = 2;
  const typename Pose::Tangent xi = isotherm_test::random_tangent<Pose>(random, 0.1);
  self.T_from_to = Pose::exp(xi);
  self.information = 4.0 * Pose::Matrix::Identity();
  graph.constraints.push_back(self);
  const auto result = odometry_chi2(graph, edge_roles(graph));
  EXPECT_NEAR(result[0].chi2, 4.0 * xi.squaredNorm(), 1e-10);
}

TYPED_TEST(OdometryChi2Of, NoInformationNoDisagreement) {
  using Pose = TypeParam;
  Random random(25);
  auto graph = random_chain<Pose>(random, 5);
  const auto poses = odometry_poses(graph, edge_roles(graph));
  graph.constraints.push_back(noisy_loop<Pose>(poses, 0, 4, 1.0, random));
  graph.constraints.back().information.setZero();
  EXPECT_LT(odometry_chi2(graph, edge_roles(graph))[0].chi2, 1e-9);
  EXPECT_TRUE(odometry_chi2(PoseGraph<Pose>(), EdgeRoles()).empty());
}

}  // namespace
}  // namespace isotherm::slam
