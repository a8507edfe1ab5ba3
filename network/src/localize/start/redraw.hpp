#pragma once

#include <vector>

#include "localize/start/path_map.hpp"

namespace isotherm::network::detail {

/// The map with the surroundings of what contradicts it drawn anew: around the node with the most
/// trusted pairs beyond the gate, then around the next one that is in no such region, all within
/// some steps from its shortest paths as a network of its own, whose outermost nodes say where it
/// lies. Paths are short in a region: there a part comes to its place that in the large map turned
/// the wrong way. Only regions around nodes in `among` count: those near what has changed since
/// they were drawn last.
Placement redraw(const MapTask& task, const std::vector<bool>& among, const Placement& placement);

}  // namespace isotherm::network::detail
