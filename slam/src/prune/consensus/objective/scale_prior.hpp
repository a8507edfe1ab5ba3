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

/// Deviation of the log of a factor that measurements of this redundancy tell, too: their
/// likelihood has curvature redundancy / 2 at its peak (Laplace).
inline double scale_deviation(double redundancy) {
  return 1.0 / std::sqrt(0.5 * redundancy + 1.0 / (kScaleDeviation * kScaleDeviation));
}

}  // namespace isotherm::slam::detail
