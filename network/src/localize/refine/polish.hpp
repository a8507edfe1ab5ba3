#pragma once

#include <vector>

#include "localize/problem/map_task.hpp"

namespace isotherm::network::detail {

/// From near a maximum of the objective to it: to where the kinds of all ranges, and the absence of
/// others, are likeliest, and moves of single nodes by which the map becomes likelier, by turns.
/// Least squares of what fits knows neither how far away ends of a range that is too long may be
/// nor that nodes without a range are not near each other. @throws Cancelled
void polish(const MapTask& task, Placement& placement);

}  // namespace isotherm::network::detail
