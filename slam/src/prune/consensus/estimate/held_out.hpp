#pragma once

#include <vector>

#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/estimate/map_volume.hpp"
#include "prune/consensus/estimate/reduced_graph.hpp"

namespace isotherm::slam::detail {

/// What all other accepted loops and odometry say of an accepted one.
struct HeldOut {
  Index loop = 0;
  Evidence evidence;
};

/// Of every loop of `accepted` between two poses, in order. `estimate` must have been updated
/// with them, their covariances scaled by `loop_scale`; costs one pass for covariances.
template <class Pose>
std::vector<HeldOut> held_out(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                              const std::vector<bool>& accepted, double loop_scale,
                              const MapVolume<Pose>& map);

}  // namespace isotherm::slam::detail
