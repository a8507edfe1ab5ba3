#pragma once

#include <utility>
#include <vector>

#include "prune/consensus/estimate/reduced_graph.hpp"

namespace isotherm::slam::detail {

/// Pairs of loops, the first below the second, whose two ends both lie within `window`
/// vertices of each other along the same chains, whichever way a loop is stated. A loop
/// with many such neighbours is paired with the nearest only. Sorted; O(q log q).
template <class Pose>
std::vector<std::pair<Index, Index>> near_pairs(const ReducedGraph<Pose>& graph, Index window);

}  // namespace isotherm::slam::detail
