#include "prune/consensus/objective/scale_prior.hpp"

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
    EXPECT_NEAR(log_scale_peak(logs, redundancy), dense_peak(logs, redundancy), 1e-9);
  }
}

TEST(ScalePrior, CountsOneFactorWhereItIsOneForAll) {
  const Tangent logs = log_scales(std::exp(2.0), Tangent(Tangent::Ones()));
  const Tangent redundancy = Tangent::Constant(3.0);
  const double precision = 1.0 / (kScaleDeviation * kScaleDeviation);
  EXPECT_NEAR(log_scale_peak(logs, redundancy),
              -0.5 * 4.0 * precision - 0.5 * std::log((9.0 + precision) / precision), 1e-12);
}

}  // namespace
}  // namespace isotherm::slam::detail
