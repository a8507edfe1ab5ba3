#include "prune/consensus/calibrate/heavy_tail.hpp"

#include <algorithm>
#include <cmath>

#include "isotherm/base/statistics.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kMiddle = 0.5;
constexpr double kUpper = 0.9;
constexpr double kTailDeviations = 2.0;
// Of the logarithm of the ratio of both quantiles, times the root of their number: 1.3
// for 3 degrees of freedom and 0.9 for 6 where errors are Gaussian, more in heavy tails.
constexpr double kDeviationOfOne = 1.5;
constexpr double kCauchy = 1.0;      // degrees of freedom of Student's distribution: the least
constexpr double kGaussian = 200.0;  // and as good as infinitely many
constexpr int kHalvings = 40;
constexpr double kWithoutErrors = 1e-8;  // chi-squared of data without errors

double over_median(double probability, int dof, double nu) {
  return f_quantile(probability, dof, nu) / f_quantile(kMiddle, dof, nu);
}

// Those under which the upper quantile is `ratio` times the median: fewer, the larger it is.
double degrees_of_freedom(double ratio, int dof) {
  double low = std::log(kCauchy);
  double high = std::log(kGaussian);
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    const bool too_heavy = over_median(kUpper, dof, std::exp(middle)) > ratio;
    (too_heavy ? low : high) = middle;
  }
  return std::exp(high);
}

}  // namespace

Tail student_tail(const std::vector<double>& chi2, int dof, double probability) {
  const double middle = std::max(quantile(chi2, kMiddle), kWithoutErrors);
  const double upper = std::max(quantile(chi2, kUpper), middle);
  const double error =
      kTailDeviations * kDeviationOfOne / std::sqrt(static_cast<double>(chi2.size()));
  const double nu = degrees_of_freedom(upper / middle * std::exp(error), dof);
  const double student = over_median(1.0 - probability, dof, nu);
  const double gaussian =
      chi_squared_quantile(1.0 - probability, dof) / chi_squared_quantile(kMiddle, dof);
  return {middle * student, std::max(1.0, student / gaussian)};
}

}  // namespace isotherm::slam::detail
