#pragma once

#include <vector>

#include "isotherm/slam/graph/diagnose.hpp"

namespace isotherm::slam::detail {

/// Measurements that would fit if they were read otherwise: ends swapped, angles in degrees.
template <class Pose>
std::vector<Doubt> doubt_measurements(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

}  // namespace isotherm::slam::detail
