#pragma once

#include <vector>

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

/// Calls `climb_from` with each of kStarts in turn, and without `calibrate` with the file's alone.
template <class Function>
void climb_from_each_start(bool calibrate, Function&& climb_from) {
  for (const auto& [odometry, loops] : kStarts) {
    unless_it_breaks_down(climb_from, CovarianceScale{odometry, loops});
    if (!calibrate) break;
  }
}

/// Where none of kStarts leads anywhere: factors of a grid over what is believed of them where more
/// gains from nothing than at those around, the most first. Of stated covariances far from true no
/// loop agrees with the next, and no climb begins.
template <class Pose>
std::vector<CovarianceScale> gaining_starts(Climb<Pose>& climb);

}  // namespace isotherm::slam::detail
