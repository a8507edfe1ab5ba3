#pragma once

#include <cmath>

namespace isotherm::slam::detail {

inline double log_odds_of(double probability) {
  return std::log(probability / (1.0 - probability));
}

}  // namespace isotherm::slam::detail
