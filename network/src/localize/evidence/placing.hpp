#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/problem/range_problem.hpp"

/// Moves of single nodes among their neighbours.
namespace isotherm::network::detail {

/// Places nodes that have more than d ranges to placed ones that agree, as long as there
/// are any, nodes with more ranges first. A place counts if the next best is clearly
/// worse.
void place_more(const RangeProblem& problem, double gate, const Evidence& evidence,
                Placement& placement);

/// Moves those nodes `among` all that have a range beyond the gate, or stand beside others
/// without a range to them, to where their neighbours agree on better. Which moved.
std::vector<Index> relocate(const RangeProblem& problem, double gate, const Evidence& evidence,
                            const LocalizeOptions& options, const std::vector<bool>& among,
                            Placement& placement);

}  // namespace isotherm::network::detail
