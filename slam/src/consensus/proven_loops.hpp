#pragma once

#include <vector>

#include "estimate.hpp"
#include "reduced_graph.hpp"

namespace isotherm::slam::detail {

/// How many accepted loops the others prove, on the map of `estimate`.
///
/// A loop held out must be likelier than one anywhere on that map by `required_odds` (log). On
/// a map that false loops have drawn together to a point, every loop says what all say, and
/// none is proven. `estimate` must have been updated with `accepted`, and a covariance of
/// loops scaled by `loop_scale`; costs one pass for covariances.
template <class Pose>
Index count_proven(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                   const std::vector<bool>& accepted, double loop_scale, double required_odds);

}  // namespace isotherm::slam::detail
