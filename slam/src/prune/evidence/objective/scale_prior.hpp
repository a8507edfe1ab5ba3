#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isotherm::slam::detail {

/// Deviation of the log of a factor on covariances: that of a factor of ten in sigma.
inline constexpr double kScaleDeviation = 2.0 * std::numbers::ln10;

/// Up to a constant.
inline double log_scale_prior(double scale) {
  const double deviations = std::log(scale) / kScaleDeviation;
  return -0.5 * deviations * deviations;
}

}  // namespace isotherm::slam::detail
