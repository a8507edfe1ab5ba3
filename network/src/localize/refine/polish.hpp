#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// From near a maximum of the objective to it: to where the kinds of all ranges, and the absence of
/// others, are likeliest, and moves of single nodes by which the map becomes likelier, by turns.
/// Least squares of what fits knows neither how far away ends of a range that is too long may be
/// nor that nodes without a range are not near each other. @throws Cancelled
void polish(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
            const LocalizeOptions& options, Placement& placement);

}  // namespace isotherm::network::detail
