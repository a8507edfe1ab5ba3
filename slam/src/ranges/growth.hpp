#pragma once

#include <vector>

#include "isotherm/base/run_context.hpp"
#include "ranges/fit.hpp"
#include "ranges/known_world.hpp"

namespace isotherm::slam::detail {

/// A map as far as it goes.
template <class Pose>
struct GrownMap {
  RangeEstimate<Pose> estimate;
  Bodies bodies;
  std::vector<bool> mirrored;  ///< one a node: another place explains as much
  int iterations = 0;
};

/// The start of `locate`. Poses are chained along odometry, in windows of time that grow by half;
/// in each, beacons and robots join the bodies to which their ranges leave only one place, the rest
/// waits, and all is fitted. What waits to the end is put where the fit is best. Without `windows`
/// there is but one, of all time.
/// @throws Cancelled
template <class Pose>
GrownMap<Pose> grow_map(const KnownWorld<Pose>& world, const RangeModel& model, bool windows,
                        const RunContext& run);

}  // namespace isotherm::slam::detail
