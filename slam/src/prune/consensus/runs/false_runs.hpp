#pragma once

#include <span>
#include <vector>

#include "prune/consensus/runs/runs.hpp"

namespace isotherm::slam::detail {

/// False loops come in runs, too: where one place is taken for another so are its neighbours, and
/// what they measure follows from the one before as a true one's does. So a false loop after a
/// false one in its run is drawn by chance or, kFalseFollowing of them, follows the one before:
/// that they agree is no sign then that they are true.
///
/// Of each loop, log of how much likelier it is after a false one than by chance; 0 where it or the
/// one before is `accepted`, or none is before it. `log_led`: log of the density of what it
/// measures as it follows from the one before, over that of near pairs: around it, or by chance
/// where that is more.
template <class Pose>
std::vector<double> log_follows(const Runs<Pose>& runs, const std::vector<bool>& accepted,
                                std::span<const double> log_led);

}  // namespace isotherm::slam::detail
