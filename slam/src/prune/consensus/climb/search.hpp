#pragma once

#include <vector>

#include "prune/consensus/climb/climb.hpp"

namespace isotherm::slam::detail {

/// The explanations that `climb` finds for all loops of its objective, the best first, each once;
/// that none is true is one. Of many loops a sample is searched before, in the same way: evidence
/// is a sum over loops, so that what is decisively worse there is not followed.
/// @throws NumericalError, Cancelled
template <class Pose>
std::vector<Explanation<Pose>> search(Climb<Pose>& climb);

}  // namespace isotherm::slam::detail
