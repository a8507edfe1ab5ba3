#pragma once

#include <span>
#include <string>
#include <vector>

#include "heat/heat_bracket.hpp"
#include "heat/rational_heat.hpp"

namespace isotherm::spectral::detail {

/// Which scales go to which method, and why. Decided from counted operations,
/// so that the choice never depends on the machine or on how busy it is.
struct HeatPlan {
  std::vector<bool> rational;        ///< per scale
  std::vector<std::string> reasons;  ///< per scale
};

/// Mean time of local Lanczos a target until each scale is bracketed, in
/// nanoseconds, from a few targets spread over the list. Scales not reached
/// within `budget` nanoseconds a target are infinitely expensive.
std::vector<double> lanczos_costs(HeatBracketer& bracketer, std::span<const HeatTarget> targets,
                                  const HeatGoal& goal, double budget);

/// Splits the scales so that the sum of both methods' costs is least. One
/// Lanczos run serves every scale below its largest, so the rational ones are
/// the largest scales.
/// @param lanczos mean cost a target until each scale is reached
/// @param rational cost of one scale in all
/// @param setup cost of the first rational scale on top
HeatPlan plan(std::span<const double> scales, std::span<const double> lanczos,
              std::size_t target_count, double rational, double setup);

}  // namespace isotherm::spectral::detail
