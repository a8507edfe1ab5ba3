#pragma once

#include <algorithm>
#include <cmath>

namespace isotherm::slam::detail {

/// log(exp(a) + exp(b)), without overflow; one of them may be minus infinity.
inline double log_sum(double a, double b) {
  return std::max(a, b) + std::log1p(std::exp(-std::abs(a - b)));
}

}  // namespace isotherm::slam::detail
