#include "matrices/nearest_rotation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "isotherm/base/random.hpp"

namespace isotherm::slam::detail {
namespace {

Eigen::Matrix3d random_matrix(Random& random) {
  Eigen::Matrix3d matrix;
  for (int k = 0; k < 9; ++k) matrix(k) = random.normal();
  return matrix;
}

Eigen::Matrix3d random_rotation(Random& random) {
  const Eigen::Vector4d q(random.normal(), random.normal(), random.normal(), random.normal());
  return Eigen::Quaterniond(q).normalized().toRotationMatrix();
}

// A rotation times a positive definite matrix is its polar decomposition, which is unique.
TEST(NearestRotation, IsThatOfThePolarDecomposition) {
  Random random(1);
  for (int draw = 0; draw < 20; ++draw) {
    const Eigen::Matrix3d R = random_rotation(random);
    const Eigen::Matrix3d A = random_matrix(random);
    const Eigen::Matrix3d stretch = A * A.transpose() + Eigen::Matrix3d::Identity();
    const auto found = nearest_rotation(R * stretch);
    EXPECT_LT((found.rotation - R).norm(), 1e-12);
    EXPECT_NEAR(found.singular_values.sum(), stretch.trace(), 1e-12 * stretch.trace());
  }
}

TEST(NearestRotation, IsNearerThanOthersAndNoReflection) {
  Random random(2);
  for (int draw = 0; draw < 20; ++draw) {
    const Eigen::Matrix3d A = random_matrix(random);
    const Eigen::Matrix3d R = nearest_rotation(A).rotation;
    EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
    for (int other = 0; other < 20; ++other) {
      EXPECT_LE((A - R).norm(), (A - random_rotation(random)).norm() + 1e-12);
    }
  }
}

TEST(NearestRotation, InThePlaneTurnsByTheAngleOfTheMatrix) {
  const Eigen::Matrix2d A = 3.0 * Eigen::Rotation2Dd(0.7).toRotationMatrix();
  EXPECT_LT((nearest_rotation(A).rotation - A / 3.0).norm(), 1e-14);
}

TEST(NearestRotation, OfZeroIsARotation) {
  const Eigen::Matrix3d R = nearest_rotation(Eigen::Matrix3d::Zero()).rotation;
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_NEAR(R.determinant(), 1.0, 1e-14);
}

}  // namespace
}  // namespace isotherm::slam::detail
