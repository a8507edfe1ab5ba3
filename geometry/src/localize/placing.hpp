#pragma once

#include <vector>

#include "isotherm/geometry/localize.hpp"
#include "localize/range_problem.hpp"

/// Moves of single nodes among their neighbours.
namespace isotherm::geometry::detail {

/// Places nodes that have at least d + 1 agreeing ranges to placed ones, as long as
/// there are any, nodes with more ranges first. A place counts if the next best is
/// worse by `mirror_gate`. How many were placed.
Index place_more(const RangeProblem& problem, double gate, double mirror_gate,
                 Placement& placement);

/// Moves nodes with a range beyond the gate to where their neighbours agree on
/// better, in order. How many moved.
Index relocate(const RangeProblem& problem, double gate, Placement& placement);

/// Which placed nodes fit elsewhere nearly as well: the next best place is worse by
/// less than `mirror_gate`.
std::vector<bool> fits_elsewhere(const RangeProblem& problem, double gate, double mirror_gate,
                                 const Placement& placement);

}  // namespace isotherm::geometry::detail
