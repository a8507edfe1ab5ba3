#pragma once

#include <vector>

#include "prune/consensus/objective/error_scales.hpp"
#include "prune/consensus/runs/runs.hpp"

namespace isotherm::slam::detail {

/// log of the density of what each loop measures, as the one before it in its run predicts that; 0
/// of those without one and where both are `accepted`. Loops err as is expected of them, by
/// `stated` and by `graph`, which has the factors on coordinates.
template <class Pose>
std::vector<double> run_density(const Runs<Pose>& runs, const ReducedGraph<Pose>& graph,
                                const ReducedGraph<Pose>& stated, const CovarianceScale& scale,
                                const ScaleMixture& mixture, const std::vector<bool>& accepted,
                                int threads = 1);

}  // namespace isotherm::slam::detail
