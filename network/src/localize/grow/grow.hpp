#pragma once

#include <limits>
#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Places nodes around those that `placement` has, in waves: of the nodes with placed
/// neighbours, those on whose place the most trusted pairs agree and that nothing else
/// comes near come first, weaker ones when no such are left. Of two places of a node the
/// one is taken from which a small trial map explains clearly more. Whenever the map is larger
/// by a part, and at the end of a wave that placed nothing, it is refined, and nodes that
/// most of their pairs disagree with lose their place. After "robust quads" (D. Moore,
/// J. Leonard, D. Rus, S. Teller, "Robust distributed network localization with noisy
/// range measurements", 2004), with a robust estimate in place of the quad.
/// Ends where nothing is left to place, or with the wave that reaches `limit` nodes.
void grow(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
          const Evidence& evidence, const LocalizeOptions& options, Placement& placement,
          Index limit = std::numeric_limits<Index>::max());

}  // namespace isotherm::network::detail
