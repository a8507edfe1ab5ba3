#pragma once

#include <vector>

#include "localize/problem/map_task.hpp"
#include "localize/refine/refine.hpp"

namespace isotherm::network::detail {

/// Whether each range's ends are placed and its deviation's square is within the gate.
std::vector<bool> ranges_within(const RangeProblem& problem, const Placement& placement,
                                double gate);

/// Whether each range is of a trusted pair and not far outside a loss of this width, in standard
/// deviations.
std::vector<bool> ranges_in_reach(const MapTask& task, const Placement& placement, double width);

/// Moves the nodes to a minimum of Geman and McClure's loss of this width, in standard
/// deviations, of the ranges that are not far outside it. @throws Cancelled
void refine_at_width(const MapTask& task, double width, Placement& placement);

/// Robust refinement from a rough start: the loss narrows from where half of the ranges
/// are well inside down to `sqrt(gate)` standard deviations. Ranges far outside, and until the last
/// stage those that are not trusted, are left out (false ranges between far nodes would fill the
/// factorisation). Then nodes in wrong places are moved and the fit repeated until none is.
void refine_robustly(const MapTask& task, Placement& placement);

}  // namespace isotherm::network::detail
