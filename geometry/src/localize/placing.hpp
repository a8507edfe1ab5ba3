#pragma once

#include <vector>

#include "isotherm/geometry/localize.hpp"
#include "localize/evidence.hpp"
#include "localize/range_problem.hpp"

/// Moves of single nodes among their neighbours.
namespace isotherm::geometry::detail {

/// Places nodes that have more than d ranges to placed ones that agree, as long as there
/// are any, nodes with more ranges first. A place counts if the next best is clearly
/// worse.
void place_more(const RangeProblem& problem, double gate, const Evidence& evidence,
                Placement& placement);

/// Moves nodes with a range beyond the gate to where their neighbours agree on
/// better, and nodes that stand beside others without a range to them. How many moved.
Index relocate(const RangeProblem& problem, double gate, const Evidence& evidence,
               const LocalizeOptions& options, Placement& placement);

}  // namespace isotherm::geometry::detail
