#pragma once

#include <vector>

#include "isotherm/base/random.hpp"
#include "isotherm/slam/simulate/simulate.hpp"

namespace isotherm::slam::detail {

/// The pose graph of noisy measurements along `path`, which is moved so that it
/// starts at the identity. Vertices are numbered from 0.
/// @throws InvalidArgument if the path cannot drift as far as asked
template <class Pose>
Simulation<Pose> measure_path(std::vector<Pose> path, const MeasurementOptions& options,
                              Random& random);

}  // namespace isotherm::slam::detail
