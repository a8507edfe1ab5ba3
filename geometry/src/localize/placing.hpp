#pragma once

#include <vector>

#include "isotherm/geometry/localize.hpp"
#include "localize/range_problem.hpp"

/// Moves of single nodes among their neighbours.
namespace isotherm::geometry::detail {

/// What a range that does not fit costs, in chi-squared, as the usable pairs between
/// placed nodes have it: twice the log of how much likelier a fitting range is a correct one
/// than a false one of any length. It rises as fewer ranges are found false.
double outlier_cost(const RangeProblem& problem, const std::vector<bool>& usable,
                    const Placement& placement, double gate);

/// Places nodes that have more than d ranges to placed ones that agree, as long as there
/// are any, nodes with more ranges first. A place counts if the next best is clearly
/// worse.
void place_more(const RangeProblem& problem, double gate, Placement& placement);

/// Moves nodes with a range beyond the gate to where their neighbours agree on
/// better. How many moved.
Index relocate(const RangeProblem& problem, double gate, const LocalizeOptions& options,
               Placement& placement);

}  // namespace isotherm::geometry::detail
