#pragma once

#include <vector>

#include "localize/problem/map_task.hpp"

namespace isotherm::network::detail {

/// Mirrors the parts of a refined map whose mirror image fits better, and brings home loose ones,
/// those that gain most first, and refines it again, as long as there are any; whether there were.
/// A map of springs does not do that by itself: on the way over a hinge everything fits worse, and
/// nothing draws a loose part that is far from its place.
bool open_folds(const MapTask& task, Placement& placement);

}  // namespace isotherm::network::detail
