#include "prune/consensus/objective/scale_prior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Of the variance of 100 normal steps, what they vary by beside errors at its likeliest.
TEST(ScalePrior, ErrorsThatVaryMoreThanStepsAreUnlikely) {
  constexpr double kSteps = 100.0;
  const auto log_likelihood = [](double seen, double errors) {
    double best = -std::numeric_limits<double>::infinity();
    for (double motion = 0.0; motion < 20.0; motion += 1e-3) {
      const double variance = errors + motion;
      best = std::max(best, -0.5 * kSteps * (std::log(variance) + seen / variance));
    }
    return best;
  };
  const Eigen::Vector3d seen(3.0, 0.5, 2.0);
  const Eigen::Vector3d errors(1.0, 1.0, 3.0);
  double expected = 0.0;
  for (int d = 0; d < 3; ++d) {
    expected += log_likelihood(seen[d], seen[d]) - log_likelihood(seen[d], errors[d]);
  }
  const Eigen::Vector3d logs = errors.array().log();
  const Eigen::Vector3d most = seen.array().log();
  EXPECT_NEAR(log_excess(logs, most, kSteps), expected, 1e-4);
  EXPECT_EQ(log_excess(most, most, kSteps), 0.0);
}

TEST(ScalePrior, ScaleAndShapeAreTheLogsTheOtherWayRound) {
  const Eigen::Vector3d logs(0.3, -2.0, 5.0);
  const auto [scale, shape] = scale_and_shape(logs);
  EXPECT_NEAR(shape.array().log().sum(), 0.0, 1e-12);
  EXPECT_LT((log_scales(scale, shape) - logs).norm(), 1e-12);
}

}  // namespace
}  // namespace isotherm::slam::detail
