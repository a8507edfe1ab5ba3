#pragma once

#include <cmath>
#include <limits>

namespace isotherm::slam::detail {

/// Nats beyond the last digit of a double: what is so much less likely changes no probability.
inline constexpr double kNoDigit = 40.0;

inline double log_odds_of(double probability) {
  return std::log(probability / (1.0 - probability));
}

/// The other way. Below the least normal number it is 0: many readers of numbers take others for
/// errors.
inline double probability_of(double log_odds) {
  const double probability = 1.0 / (1.0 + std::exp(-log_odds));
  return probability < std::numeric_limits<double>::min() ? 0.0 : probability;
}

}  // namespace isotherm::slam::detail
