#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "isotherm/base/error.hpp"
#include "prune/consensus/climb/climb.hpp"
#include "prune/consensus/objective/scale_prior.hpp"

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
  for (const StartScales& start : std::span(kStarts).first(kStartsAlways)) {
    unless_it_breaks_down(climb_from, start);
    if (!calibrate) break;
  }
}

/// The best of these loops from the poses found with them, and from loops a deviation of their
/// prior more and less accurate than found, as long as that leads to other scales: they may have
/// more than one peak, between which lessons do not lead, and a loop that has drawn the map to
/// itself looks accurate there.
template <class Pose>
Explanation<Pose> settled_on_either_side(Climb<Pose>& climb, Explanation<Pose> found) {
  CovarianceScale before;
  do {
    before = found.scale;
    for (const double change : {-kScaleDeviation, kScaleDeviation}) {
      const double log_scale = std::log(found.scale.loops) + change;
      const double loops = std::exp(std::clamp(log_scale, -kMostScale, kMostScale));
      const auto settle = [&](const CovarianceScale& start) {
        auto other = climb.settled_near(found, start);
        if (other.evidence > found.evidence) found = std::move(other);
      };
      unless_it_breaks_down(settle, CovarianceScale{found.scale.odometry, loops});
    }
  } while (!about_the_same(found.scale, before));
  return found;
}

/// Adds to what was found what explains best that exactly these loops are true: by climbs from each
/// start to which only these are offered, which no other loops or peaks lead astray, and from the
/// best with scales on either side. `accepted` is a copy, since it may be of one in `found`, which
/// grows.
template <class Pose>
void settle_on(Climb<Pose>& climb, const std::vector<bool> accepted,
               std::vector<Explanation<Pose>>& found) {
  const bool calibrate = climb.options().calibrate;
  climb_from_each_start(
      calibrate, [&](const auto& start) { found.push_back(climb.settled_on(accepted, start)); });
  if (calibrate && !found.empty()) {
    found.push_back(settled_on_either_side(climb, best_of(found)));
  }
}

}  // namespace isotherm::slam::detail
