#pragma once

#include <vector>

#include "localize/fold/part_move.hpp"
#include "localize/problem/map_task.hpp"

namespace isotherm::network::detail {

/// The parts of a map that are elsewhere in another one of the same frame, as they are there:
/// connected nodes that are farther apart in both than noise, than twice that, and so on up to a
/// typical range. Each part once.
std::vector<PartMove> differing_parts(const MapTask& task, const Placement& placement,
                                      const Placement& other);

/// Takes from another map of the same frame the parts that are likelier there, and refines the
/// map, as long as there are any; whether there were.
bool recombine(const MapTask& task, const Placement& other, Placement& placement);

}  // namespace isotherm::network::detail
