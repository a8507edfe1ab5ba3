#pragma once

#include <vector>

#include "isotherm/geometry/localize.hpp"
#include "localize/range_problem.hpp"
#include "localize/refine.hpp"

namespace isotherm::geometry::detail {

/// Whether each range's ends are placed and its deviation's square is within the gate.
std::vector<bool> ranges_within(const RangeProblem& problem, const Placement& placement,
                                double gate);

/// Moves the nodes to a minimum of Geman and McClure's loss of this width, in standard
/// deviations, of the ranges that are not far outside it. @throws Cancelled
RefineOutcome refine_at_width(const RangeProblem& problem, double width, int max_iterations,
                              const LocalizeOptions& options, Placement& placement);

/// Robust refinement from a rough start: the loss narrows from where half of the ranges
/// are well inside down to `sqrt(gate)` standard deviations, ranges far outside
/// being left out of each stage (a false range between far nodes would fill the
/// factorisation), then nodes in wrong places are moved and the fit repeated until
/// none is.
RefineOutcome refine_robustly(const RangeProblem& problem, const std::vector<bool>& trusted,
                              double gate, const LocalizeOptions& options, Placement& placement);

}  // namespace isotherm::geometry::detail
