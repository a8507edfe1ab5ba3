#pragma once

#include <cstdint>
#include <vector>

#include "isotherm/spectral/edges/judge_edges.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace isotherm::spectral::detail {

/// Pairs of different vertices that no edge joins, in order of the first, with
/// repetitions: up to 50 a vertex with an edge, and 100,000 in all.
///
/// For `anywhere`, both are drawn evenly from the vertices with an edge. For `near`, the
/// second is where a random walk of 3 to 8 steps from the first ends, if the two have no
/// neighbour in common.
std::vector<VertexPair> control_pairs(const WeightedGraph& graph, ControlGroup control,
                                      std::uint64_t seed);

}  // namespace isotherm::spectral::detail
