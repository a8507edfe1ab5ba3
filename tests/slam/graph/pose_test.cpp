#include "isotherm/slam/graph/pose.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"

namespace isotherm::slam {
namespace {

// A tangent whose rotation part has exactly the given angle.
template <class Pose>
typename Pose::Tangent random_tangent(Random& random, double angle) {
  typename Pose::Tangent xi;
  for (int i = 0; i < Pose::kDof; ++i) xi[i] = random.normal();
  auto rotation = xi.template tail<Pose::kDof - Pose::kDim>();
  rotation *= angle / rotation.norm();
  return xi;
}

// Largest difference of the images of the frame's own axes and origin.
template <class Pose>
double distance(const Pose& a, const Pose& b) {
  double worst = (a.translation() - b.translation()).norm();
  return std::max(worst, (a.rotation_matrix() - b.rotation_matrix()).norm());
}

template <class Pose>
class PoseLaws : public testing::Test {
 protected:
  static constexpr double kAngles[] = {
      0.0, 1e-12, 1e-6, 1e-3, 0.2, 0.299, 0.301, 1.0, 2.5, 3.1, std::numbers::pi - 1e-9};
  Random random{11};
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(PoseLaws, Poses);

TYPED_TEST(PoseLaws, GroupAxioms) {
  using Pose = TypeParam;
  for (int i = 0; i < 50; ++i) {
    const Pose a = Pose::exp(random_tangent<Pose>(this->random, 2.0));
    const Pose b = Pose::exp(random_tangent<Pose>(this->random, 1.0));
    const Pose c = Pose::exp(random_tangent<Pose>(this->random, 3.0));
    EXPECT_LT(distance((a * b) * c, a * (b * c)), 1e-13);
    EXPECT_LT(distance(a * Pose(), a), 1e-14);
    EXPECT_LT(distance(Pose() * a, a), 1e-14);
    EXPECT_LT(distance(a * a.inverse(), Pose()), 1e-14);
    EXPECT_LT(distance(a.inverse() * a, Pose()), 1e-14);
    EXPECT_LT(distance(a.between(c), a.inverse() * c), 1e-13);
    const typename Pose::Translation point = c.translation();
    EXPECT_LT(((a * b) * point - a * (b * point)).norm(), 1e-13);
  }
}

TYPED_TEST(PoseLaws, LogInvertsExpAtEveryAngle) {
  using Pose = TypeParam;
  for (const double angle : this->kAngles) {
    for (int i = 0; i < 20; ++i) {
      const auto xi = random_tangent<Pose>(this->random, angle);
      // Near pi the map from rotation to translation is badly conditioned only
      // through the angle's own rounding.
      EXPECT_LT((Pose::exp(xi).log() - xi).norm(), 1e-13 * (1 + xi.norm())) << angle;
    }
  }
}

TYPED_TEST(PoseLaws, RotationLogIsTheLastPartOfLog) {
  using Pose = TypeParam;
  for (const double angle : this->kAngles) {
    const Pose T = Pose::exp(random_tangent<Pose>(this->random, angle));
    EXPECT_EQ(T.rotation_log(), (T.log().template tail<Pose::kDof - Pose::kDim>())) << angle;
  }
}

TYPED_TEST(PoseLaws, ExpIsAOneParameterGroup) {
  using Pose = TypeParam;
  for (const double angle : this->kAngles) {
    const auto xi = random_tangent<Pose>(this->random, angle);
    EXPECT_LT(distance(Pose::exp(0.3 * xi) * Pose::exp(0.7 * xi), Pose::exp(xi)), 1e-12) << angle;
  }
}

TYPED_TEST(PoseLaws, RotationAngleIsTheSizeOfTheRotation) {
  using Pose = TypeParam;
  for (const double angle : this->kAngles) {
    const Pose pose = Pose::exp(random_tangent<Pose>(this->random, angle));
    EXPECT_NEAR(pose.rotation_angle(), angle, 1e-14);
    EXPECT_NEAR(pose.inverse().rotation_angle(), angle, 1e-14);
  }
}

TYPED_TEST(PoseLaws, AdjointMovesAPerturbationToTheLeft) {
  using Pose = TypeParam;
  for (const double angle : this->kAngles) {
    const Pose pose = Pose::exp(random_tangent<Pose>(this->random, angle));
    const auto xi = random_tangent<Pose>(this->random, 0.4);
    EXPECT_LT(distance(pose * Pose::exp(xi), Pose::exp(pose.adjoint() * xi) * pose), 1e-13);
  }
}

TYPED_TEST(PoseLaws, RightJacobianIsTheDerivativeOfExp) {
  using Pose = TypeParam;
  const double h = 1e-6;
  for (const double angle : {0.0, 1e-9, 5e-3, 0.29, 0.31, 1.5, 3.0}) {
    const auto xi = random_tangent<Pose>(this->random, angle);
    typename Pose::Matrix numeric;
    for (int k = 0; k < Pose::kDof; ++k) {
      typename Pose::Tangent step = Pose::Tangent::Zero();
      step[k] = h;
      const auto forward = (Pose::exp(xi).inverse() * Pose::exp(xi + step)).log();
      const auto backward = (Pose::exp(xi).inverse() * Pose::exp(xi - step)).log();
      numeric.col(k) = (forward - backward) / (2 * h);
    }
    EXPECT_LT((Pose::right_jacobian(xi) - numeric).norm(), 1e-8) << angle;
    const typename Pose::Matrix product =
        Pose::right_jacobian(xi) * Pose::right_jacobian_inverse(xi);
    EXPECT_LT((product - Pose::Matrix::Identity()).norm(), 1e-12) << angle;
  }
}

TEST(WrapAngle, MapsToTheHalfOpenInterval) {
  const double pi = std::numbers::pi;
  EXPECT_EQ(wrap_angle(0.5), 0.5) << "values inside stay as they are";
  EXPECT_EQ(wrap_angle(-pi), -pi);
  EXPECT_EQ(wrap_angle(pi), -pi);
  EXPECT_NEAR(wrap_angle(7.0), 7.0 - 2 * pi, 1e-15);
  EXPECT_NEAR(wrap_angle(-1e4), std::remainder(-1e4, 2 * pi), 1e-12);
}

TEST(Pose3, LogOfBothQuaternionsOfARotationAgrees) {
  Pose3::Tangent xi;
  xi << 1, 2, 3, 0.1, -0.2, 0.3;
  const Pose3 pose = Pose3::exp(xi);
  Eigen::Quaterniond negated = pose.rotation();
  negated.coeffs() *= -1.0;
  EXPECT_LT((Pose3(pose.translation(), negated).log() - xi).norm(), 1e-14);
}

TEST(Pose3, LongChainsKeepUnitQuaternions) {
  Pose3::Tangent xi;
  xi << 0.1, 0, 0, 0.01, 0.02, 0.03;
  const Pose3 step = Pose3::exp(xi);
  Pose3 pose;
  for (int i = 0; i < 100000; ++i) pose = pose * step;
  EXPECT_NEAR(pose.rotation().norm(), 1.0, 1e-15);
}

}  // namespace
}  // namespace isotherm::slam
