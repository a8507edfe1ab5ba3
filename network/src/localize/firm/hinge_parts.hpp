#pragma once

#include <vector>

#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// What hangs on the rest of the network by the neighbourhood of a node: the small parts, of 3
/// to 200 nodes in ascending order, that the `placed` nodes fall into without `hinge` and its
/// neighbours by trusted pairs. Such a part may turn as a whole where each node of it
/// seems to have one place among the others. O(degree^2 + 200 * degree).
std::vector<std::vector<Index>> parts_behind(const RangeProblem& problem,
                                             const std::vector<bool>& trusted,
                                             const std::vector<bool>& placed, Index hinge);

}  // namespace isotherm::network::detail
