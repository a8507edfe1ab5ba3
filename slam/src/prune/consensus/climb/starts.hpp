#pragma once

#include "isotherm/base/error.hpp"
#include "prune/consensus/constants.hpp"
#include "prune/consensus/estimate/estimate.hpp"

namespace isotherm::slam::detail {

/// Calls `climb_from` with each of kStarts in turn, and without `calibrate` with the file's alone.
/// Scales at which the normal equations break down explain nothing.
template <class Function>
void climb_from_each_start(bool calibrate, Function&& climb_from) {
  for (const auto& [odometry, loops] : kStarts) {
    try {
      climb_from(CovarianceScale{odometry, loops});
    } catch (const NumericalError&) {
      continue;
    }
    if (!calibrate) break;
  }
}

}  // namespace isotherm::slam::detail
