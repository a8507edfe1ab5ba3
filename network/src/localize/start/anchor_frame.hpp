#pragma once

#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Moves a part into the frame of the anchors in it; false, and nothing done, if these
/// leave a choice. Anchors farther off than a typical range have no say: a part that is
/// folded comes to lie right on one side of the fold at least.
bool align_to_anchors(const RangeProblem& problem, const Placement& anchors, Placement& part);

}  // namespace isotherm::network::detail
