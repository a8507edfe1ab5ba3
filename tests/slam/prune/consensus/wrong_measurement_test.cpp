#include "prune/consensus/objective/wrong_measurement.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {
namespace {

template <class Pose>
class WrongMeasurementOf : public testing::Test {
 protected:
  using Tangent = typename Pose::Tangent;
  using Matrix = typename Pose::Matrix;

  // At so many deviations of most, which are these, in some direction.
  double log_density(double deviations) const {
    return log_wrong<Pose>(deviations * root_ * direction_, root_ * root_.transpose(),
                           Matrix::Zero());
  }

  Random random_{3};
  Matrix root_ = Matrix(Matrix::Random() + 2.0 * Matrix::Identity());
  Tangent direction_ = random_.normal_vector<Tangent>().normalized();
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(WrongMeasurementOf, Poses);

// Over spheres, whose area in so many dimensions is 2 pi^(d/2) / Gamma(d/2), by the log of radius.
TYPED_TEST(WrongMeasurementOf, IntegratesToOne) {
  constexpr int kDof = TypeParam::kDof;
  const double area = 2.0 * std::pow(std::numbers::pi, 0.5 * kDof) / std::tgamma(0.5 * kDof);
  double sum = 0.0;
  constexpr double kStep = 0.01;
  for (double log_radius = -3.0; log_radius < 20.0; log_radius += kStep) {
    sum += kStep * std::exp(this->log_density(std::exp(log_radius)) + kDof * log_radius);
  }
  EXPECT_NEAR(sum * area * std::abs(this->root_.determinant()), 1.0, 1e-4);
}

TYPED_TEST(WrongMeasurementOf, IsLikeliestWhereErrorsAreAsLongAsExpectedOfTheirScale) {
  const double expected = std::sqrt(TypeParam::kDof * std::exp(kScaleDeviation));
  EXPECT_GT(this->log_density(expected), this->log_density(0.99 * expected));
  EXPECT_GT(this->log_density(expected), this->log_density(1.01 * expected));
}

// Of what is as most are, nothing; a place that is not known leaves room for that.
TYPED_TEST(WrongMeasurementOf, IsNoneWhereTheMeasurementIsRight) {
  using Pose = TypeParam;
  using Square = typename Pose::Matrix;
  using Residual = typename Pose::Tangent;
  const Square covariance = this->root_ * this->root_.transpose();
  EXPECT_LT(this->log_density(1.0), this->log_density(30.0) - 20.0);
  EXPECT_LT(log_wrong<Pose>(Residual::Zero(), covariance, Square::Zero()), -1e6);
  const Residual r = 1e3 * this->root_ * this->direction_;
  EXPECT_TRUE(std::isfinite(log_wrong<Pose>(1e6 * r, covariance, Square::Zero())));
  EXPECT_GT(log_wrong<Pose>(r, covariance, 1e6 * covariance),
            log_wrong<Pose>(10.0 * r, covariance, 1e6 * covariance));
}

}  // namespace
}  // namespace isotherm::slam::detail
