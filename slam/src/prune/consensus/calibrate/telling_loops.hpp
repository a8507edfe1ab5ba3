#pragma once

#include <vector>

#include "prune/consensus/estimate/estimate.hpp"

namespace isotherm::slam::detail {

/// Those of the `accepted` loops (one entry a loop) that say at least as much as odometry
/// does of how their ends lie to each other: the share
/// tr(C (C + Sigma)^-1) / dof of odometry's covariance C in their sum is at least half.
///
/// A loop between poses that odometry ties more closely than the loop itself adds nothing
/// to the map. Where many such loops are wrong by little they are accepted for all that,
/// and would pass for the accuracy of all loops, and of odometry.
template <class Pose>
std::vector<bool> telling_loops(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                                const std::vector<bool>& accepted, const CovarianceScale& scale);

}  // namespace isotherm::slam::detail
