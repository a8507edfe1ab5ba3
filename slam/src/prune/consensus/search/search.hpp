#pragma once

#include <vector>

#include "prune/consensus/climb/climb.hpp"

namespace isotherm::slam::detail {

/// How far a search goes.
struct SearchDepth {
  /// Whether climbs go on where as good as all is explained: see Climb::go_to_the_last().
  bool to_the_last = true;
  /// Whether a sample is as many of the loops as make one, where a tenth of them are too few.
  bool sample_soon = false;
  /// Whether what is found is but a start for others: where few verdicts can be wrong it is not
  /// explained otherwise.
  bool of_sample = false;
};

/// The explanations that `climb` finds for all loops of its objective, the best first, each once;
/// that none is true is one. Of many loops a sample is searched before, in the same way: evidence
/// is a sum over loops, so that what is decisively worse there is not followed.
/// @throws NumericalError, Cancelled
template <class Pose>
std::vector<Explanation<Pose>> search(Climb<Pose>& climb, SearchDepth depth = {});

}  // namespace isotherm::slam::detail
