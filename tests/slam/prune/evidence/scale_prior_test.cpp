#include "prune/evidence/objective/scale_prior.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

namespace isotherm::slam::detail {
namespace {

using Tangent = Eigen::Matrix<double, 6, 1>;
using Matrix = Eigen::Matrix<double, 6, 6>;

// The logs have covariance s^2 (I + 11'): a common part and one of each.
double dense_peak(const Tangent& logs, const Tangent& redundancy) {
  const Matrix covariance =
      kScaleDeviation * kScaleDeviation * (Matrix::Identity() + Matrix::Ones());
  const Matrix precision = covariance.inverse();
  const Matrix curvature = precision + 0.5 * Matrix(redundancy.asDiagonal());
  return -0.5 * logs.dot(precision * logs) +
         0.5 * std::log(precision.determinant() / curvature.determinant());
}

TEST(ScalePrior, IsThatOfACommonFactorAndOneOfEachCoordinate) {
  Tangent logs;
  logs << 1.0, -2.0, 0.5, 3.0, -0.25, 0.1;
  for (const double scale : {0.0, 1.0, 100.0}) {
    Tangent redundancy;
    redundancy << 1.0, 2.0, 0.0, 4.0, 0.5, 3.0;
    redundancy *= scale;
    const CoordinateScales<Tangent> scales(logs);
    EXPECT_LT((scales.logs() - logs).norm(), 1e-12);
    EXPECT_NEAR(scales.shape.array().log().sum(), 0.0, 1e-12);
    EXPECT_NEAR(log_scale_peak(scales, redundancy), dense_peak(logs, redundancy), 1e-9);
  }
}

TEST(ScalePrior, CountsOneFactorWhereItIsOneForAll) {
  const CoordinateScales<Tangent> scales(std::exp(2.0));
  const Tangent redundancy = Tangent::Constant(3.0);
  const double precision = 1.0 / (kScaleDeviation * kScaleDeviation);
  EXPECT_TRUE(scales.one_for_all());
  EXPECT_NEAR(log_scale_peak(scales, redundancy),
              -0.5 * 4.0 * precision - 0.5 * std::log((9.0 + precision) / precision), 1e-12);
}

}  // namespace
}  // namespace isotherm::slam::detail
