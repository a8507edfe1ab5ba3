#include "isotherm/slam/graph/usable_odometry.hpp"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "isotherm_test/random_graphs.hpp"

namespace isotherm::slam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

template <class Pose>
class UsableOdometry : public testing::Test {
 protected:
  UsableOdometry() {
    Random random(7);
    graph = isotherm_test::random_chain<Pose>(random, 20, 100.0);
  }
  typename Pose::Matrix& information(Index k) { return graph.constraints[k].information; }

  PoseGraph<Pose> graph;
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(UsableOdometry, Poses);

TYPED_TEST(UsableOdometry, OrdinaryMatricesStayAsTheyAre) {
  EXPECT_THAT(unusable_information(this->graph, edge_roles(this->graph)), IsEmpty());
  this->information(3).setZero();
  EXPECT_THAT(unusable_information(this->graph, edge_roles(this->graph)), IsEmpty());
}

TYPED_TEST(UsableOdometry, ExtremeOnesComeWithinReachOfTheOthers) {
  using Pose = TypeParam;
  using Vector = typename Pose::Tangent;
  this->information(2) = Vector::Ones() * Vector::Ones().transpose();  // rank 1
  this->information(5) *= 1e90;
  this->information(7) *= 1e-90;
  this->information(9)(0, 0) *= -1e-12;
  const auto roles = edge_roles(this->graph);
  const auto unusable = unusable_information(this->graph, roles);
  EXPECT_THAT(unusable, ElementsAre(2, 5, 7, 9));
  const auto repaired = with_usable_information(this->graph, roles, unusable);
  EXPECT_THAT(unusable_information(repaired, roles), IsEmpty());
  for (const Index k : roles.odometry) {
    const auto& given = this->graph.constraints[k].information;
    const auto& now = repaired.constraints[k].information;
    EXPECT_TRUE(is_usable_information<Pose::kDof>(now)) << k;
    const bool was_usable = std::count(unusable.begin(), unusable.end(), k) == 0;
    EXPECT_EQ(now == given, was_usable) << k;
  }
  // What was known stays: along (1, 1, ...).
  EXPECT_NEAR(repaired.constraints[2].information.sum(), this->information(2).sum(), 1e-6);
}

TYPED_TEST(UsableOdometry, UnitsPlayNoPart) {
  using Pose = TypeParam;
  typename Pose::Tangent scale = Pose::Tangent::Ones();
  scale.template head<Pose::kDim>().setConstant(1e-3);  // metres in millimetres
  this->information(4) *= 1e90;
  auto scaled = this->graph;
  for (auto& constraint : scaled.constraints) {
    constraint.information = scale.asDiagonal() * constraint.information * scale.asDiagonal();
  }
  const auto roles = edge_roles(scaled);
  EXPECT_THAT(unusable_information(scaled, roles), ElementsAre(4));
  const auto a = with_usable_information(this->graph, roles, {4}).constraints[4].information;
  const auto b = with_usable_information(scaled, roles, {4}).constraints[4].information;
  const typename Pose::Matrix back =
      scale.cwiseInverse().asDiagonal() * b * scale.cwiseInverse().asDiagonal();
  EXPECT_LT((back - a).norm(), 1e-6 * a.norm());
}

TYPED_TEST(UsableOdometry, TheFirstIsNamed) {
  this->graph.ids[3] = 1003;
  EXPECT_THAT(describe_unusable(this->graph, {2, 5}),
              testing::StartsWith("odometry edge 2, from vertex 1003 to 2, and 1 more: "));
  this->information(2)(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(with_usable_information(this->graph, edge_roles(this->graph), {2}), NumericalError);
}

}  // namespace
}  // namespace isotherm::slam
