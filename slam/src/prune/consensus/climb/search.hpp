#pragma once

#include <vector>

#include "prune/consensus/climb/climb.hpp"

namespace isotherm::slam::detail {

/// The explanations that `climb` finds for all loops of its objective, the best first, each once;
/// that none is true is one. Of many loops a sample is searched before, in the same way: evidence
/// is a sum over loops, so that what is decisively worse there is not followed. `to_the_last`:
/// other peaks of scales that explain the same loops a little better are sought, too, and a sample
/// is a tenth; otherwise it may be as much of them as makes a sample.
/// @throws NumericalError, Cancelled
template <class Pose>
std::vector<Explanation<Pose>> search(Climb<Pose>& climb, bool to_the_last = true);

}  // namespace isotherm::slam::detail
