#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Moves of single nodes `among` all by which the map becomes likelier: those with a range beyond
/// the gate, or beside others without a range to them, go to where their neighbours agree on
/// better; those without a place get one if more than d ranges agree on it. Which moved.
std::vector<Index> relocate(const RangeProblem& problem, double gate, const Evidence& evidence,
                            const LocalizeOptions& options, const std::vector<bool>& among,
                            Placement& placement);

}  // namespace isotherm::network::detail
