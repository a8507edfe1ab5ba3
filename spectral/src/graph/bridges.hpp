#pragma once

#include <vector>

#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// For each edge, whether its removal disconnects its ends: it lies on no cycle.
/// Neither parallel edges nor self-loops are bridges. O(n + m) (Tarjan 1974).
std::vector<bool> find_bridges(const WeightedGraph& graph);

}  // namespace isotherm::spectral::detail
