#pragma once

#include <vector>

#include "prune/consensus/pairs/loop_pair.hpp"

namespace isotherm::slam::detail {

/// Accepted loops that stand against each refuted one, nearest first, at most three;
/// empty for a loop that is not refuted.
///
/// Of the accepted loops whose ends lie nearest to the refuted one's along odometry,
/// those that contradict it alone, with the odometry between the ends: pair_residual() has a
/// chi-squared beyond `gate`. Where none does, the nearest, which contradict it together with
/// the rest. Only loops between
/// the same chains are looked at. O(q log q) on graphs whose loops are spread evenly.
template <class Pose>
std::vector<std::vector<Index>> name_conflicts(const ReducedGraph<Pose>& graph,
                                               const CovarianceScale& scale, double gate,
                                               const std::vector<bool>& accepted,
                                               const std::vector<bool>& refuted, int threads = 1);

}  // namespace isotherm::slam::detail
