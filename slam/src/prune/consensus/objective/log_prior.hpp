#pragma once

#include <cmath>
#include <cstddef>

namespace isotherm::slam::detail {

/// Log probability that just certain `kept` of `all` loops are true, of a share that may be any
/// (Beta-binomial).
inline double log_prior(std::size_t kept, std::size_t all) {
  const auto log_factorial = [](std::size_t n) {
    return std::lgamma(static_cast<double>(n) + 1.0);
  };
  return log_factorial(kept) + log_factorial(all - kept) - log_factorial(all + 1);
}

}  // namespace isotherm::slam::detail
