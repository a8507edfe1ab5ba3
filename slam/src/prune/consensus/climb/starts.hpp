#pragma once

#include <span>

#include "isotherm/base/error.hpp"
#include "prune/consensus/climb/climb.hpp"

namespace isotherm::slam::detail {

/// Scales at which the normal equations break down explain nothing.
template <class Function, class Start>
void unless_it_breaks_down(Function&& climb_from, const Start& start) {
  try {
    climb_from(start);
  } catch (const NumericalError&) {
    return;
  }
}

/// Calls `climb_from` with the first of kStarts in turn, without `calibrate` with the file's alone.
template <class Function>
void climb_from_each_start(bool calibrate, Function&& climb_from) {
  for (const auto& [odometry, loops] : std::span(kStarts).first(kStartsAlways)) {
    unless_it_breaks_down(climb_from, CovarianceScale{odometry, loops});
    if (!calibrate) break;
  }
}

}  // namespace isotherm::slam::detail
