#include "isotherm/slam/graph/information.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/pose.hpp"
#include "isotherm_test/random_graphs.hpp"

namespace isotherm::slam {
namespace {

TEST(CovarianceFromInformation, InvertsFullMatrices) {
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const Pose3::Matrix information = isotherm_test::random_information<Pose3>(random, 50.0);
    const Pose3::Matrix product = covariance_from_information<6>(information) * information;
    EXPECT_LT((product - Pose3::Matrix::Identity()).norm(), 1e-8);
  }
}

TEST(CovarianceFromInformation, UnknownDirectionsGetTheUnknownVariance) {
  const Eigen::Matrix3d none = covariance_from_information<3>(Eigen::Matrix3d::Zero());
  EXPECT_EQ(none, Eigen::Matrix3d(kUnknownVariance * Eigen::Matrix3d::Identity()));

  Eigen::Matrix3d partial = Eigen::Vector3d(4.0, 0.0, 25.0).asDiagonal();
  const Eigen::Matrix3d covariance = covariance_from_information<3>(partial);
  EXPECT_NEAR(covariance(0, 0), 0.25, 1e-12);
  EXPECT_NEAR(covariance(1, 1), kUnknownVariance, 1.0);
  EXPECT_NEAR(covariance(2, 2), 0.04, 1e-12);
}

TEST(CovarianceFromInformation, HugeWeightsStayFinite) {
  const Eigen::Matrix3d huge = 1e300 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(covariance_from_information<3>(huge)(0, 0), 1e-300, 1e-312);
}

TEST(CovarianceFromInformation, RejectsNan) {
  Eigen::Matrix3d bad = Eigen::Matrix3d::Identity();
  bad(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(covariance_from_information<3>(bad), NumericalError);
}

}  // namespace
}  // namespace isotherm::slam
