#pragma once

#include <array>

#include "isotherm/base/error.hpp"
#include "prune/consensus/estimate/estimate.hpp"

namespace isotherm::slam::detail {

/// Factors on the stated covariances of odometry and of loops to start from. What is true agrees
/// best: a climb that starts from sharper loops than stated is not drawn to false ones first.
inline constexpr std::array<CovarianceScale, 4> kStarts = {
    {{1.0, 1.0}, {100.0, 1.0}, {1.0, 0.01}, {0.01, 0.01}}};

/// Calls `climb_from` with each in turn, and without `calibrate` with the file's alone. Scales at
/// which the normal equations break down explain nothing.
template <class Function>
void climb_from_each_start(bool calibrate, Function&& climb_from) {
  for (const auto& start : kStarts) {
    try {
      climb_from(start);
    } catch (const NumericalError&) {
      continue;
    }
    if (!calibrate) break;
  }
}

}  // namespace isotherm::slam::detail
