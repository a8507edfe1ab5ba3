#pragma once

#include <cmath>

namespace isotherm::slam::detail {

/// Factors on the covariances the file states, as calibrated from the data.
struct CovarianceScale {
  bool operator==(const CovarianceScale&) const = default;

  double odometry = 1.0;
  double loops = 1.0;
};

/// Whether both factors are, to within that of e.
inline bool about_the_same(const CovarianceScale& a, const CovarianceScale& b) {
  return std::abs(std::log(a.odometry / b.odometry)) < 1.0 &&
         std::abs(std::log(a.loops / b.loops)) < 1.0;
}

}  // namespace isotherm::slam::detail
