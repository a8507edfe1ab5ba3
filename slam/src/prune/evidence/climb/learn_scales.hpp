#pragma once

#include <vector>

#include "prune/consensus/estimate/estimate.hpp"

namespace isotherm::slam::detail {

/// The factors on the covariances of odometry and of loops at which the evidence of the accepted
/// loops is highest, to first order: variance components (Helmert), cost over redundancy, a
/// loop's redundancy being tr(I - Omega J C J'), drawn towards the file by log_scale_prior().
/// Loops count by their weights, which stay. A factor changes by at most a hundred.
template <class Pose>
CovarianceScale learn_scales(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                             const std::vector<bool>& accepted, const std::vector<double>& weights,
                             const CovarianceScale& scale);

}  // namespace isotherm::slam::detail
