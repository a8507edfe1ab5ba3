#pragma once

#include <vector>

#include "localize/problem/map_task.hpp"

namespace isotherm::network::detail {

/// On which side ranges may be wrong.
enum class Errors { any, too_long };

/// A map of the largest part that trusted pairs connect, in a frame of its own: shortest paths to
/// pilot nodes and scaling (V. de Silva, J. Tenenbaum, "Sparse multidimensional scaling using
/// landmark points", 2004), then springs, of the same pairs, whose loss narrows. Nodes nearer to
/// each other than `absence.reach()` without a range repel each other, which opens folds. With
/// `Errors::too_long` ranges shorter than the distance of their ends keep a wide loss. O(pilots *
/// ranges * log nodes) and the factorisations of the springs. Nothing is placed if there are too
/// few nodes. @throws Cancelled
Placement map_by_paths(const MapTask& task, Errors errors);

/// The springs alone, on the placed nodes of any rough map.
void unfold(const MapTask& task, Errors errors, Placement& placement);

}  // namespace isotherm::network::detail
