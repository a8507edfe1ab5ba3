#pragma once

#include <vector>

#include "isotherm/geometry/localize.hpp"
#include "localize/range_problem.hpp"

namespace isotherm::geometry::detail {

/// Pairs that the heat kernel does not suspect (all, if that test is off).
std::vector<bool> trusted_pairs(const RangeProblem& problem, const LocalizeOptions& options);

/// A first place for as many nodes as possible: patches of trusted pairs, stitched,
/// each part refined on its own if the method is robust, and brought into the frame of
/// at least d + 1 anchors that fix it. Without anchors only the largest part is
/// placed. Where too few ranges agree with the result of small patches, larger ones are
/// tried too, and the better start is taken.
Placement place_initially(const RangeProblem& problem, const Placement& anchors,
                          const std::vector<bool>& trusted, double gate,
                          const LocalizeOptions& options);

}  // namespace isotherm::geometry::detail
