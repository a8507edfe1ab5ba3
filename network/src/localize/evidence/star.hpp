#pragma once

#include <vector>

#include "localize/problem/range_problem.hpp"
#include "localize/problem/small_network.hpp"

namespace isotherm::network::detail {

/// A node, last, with those of its neighbours that are placed, which are fixed, and the
/// pairs that lead to them.
SmallNetwork star(const RangeProblem& problem, const Placement& placement, Index node);

/// The same with the `usable` pairs only.
SmallNetwork star(const RangeProblem& problem, const Placement& placement, Index node,
                  const std::vector<bool>& usable);

/// How many ranges deviate by no more than sqrt(gate) standard deviations.
int agreeing(const SmallNetwork& network, double gate);

}  // namespace isotherm::network::detail
