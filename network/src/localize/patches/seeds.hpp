#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/problem/patch.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Small maps to grow larger ones from: cliques of trusted pairs, d + 2 nodes or more,
/// that all ranges between them agree on, and that are not flat. A false range hardly
/// gets into one, for it would need true ranges from its ends to all others. One a
/// node at most, those with the most ranges beyond what fixes them first.
/// O(nodes * degree^3), in parallel.
std::vector<Patch> consistent_cliques(const RangeProblem& problem, const std::vector<bool>& trusted,
                                      double gate, const LocalizeOptions& options);

}  // namespace isotherm::network::detail
