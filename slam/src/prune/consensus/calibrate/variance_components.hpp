#pragma once

#include <vector>

#include "prune/consensus/estimate/estimate.hpp"

namespace isotherm::slam::detail {

/// Factors on the covariances of odometry and of loops under which the accepted loops
/// and odometry are as consistent as they should be; those of `scale` where there is
/// too little redundancy to tell.
///
/// Variance components (F. Helmert): cost over redundancy, a loop's redundancy being
/// tr(I - Sigma^-1 P) with its fitted covariance P, and odometry's the rest. Accepted
/// loops count with the `probability` that they are true (one a loop of the graph), as
/// in expectation maximisation: those that are merely likely are the likelier, the
/// wider the covariances, and would feed back.
template <class Pose>
CovarianceScale variance_components(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                                    const std::vector<bool>& accepted,
                                    const std::vector<double>& probability,
                                    const CovarianceScale& scale);

}  // namespace isotherm::slam::detail
