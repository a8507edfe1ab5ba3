#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Which placed nodes have one place only: the most of them of which each one's second-best place
/// among the others is less likely by the factor `options.mirror_chance`, and no part of them has a
/// mirror image of which that is not true. Nodes that have another place are taken out, and then
/// those that hung on them.
std::vector<bool> firm_nodes(const RangeProblem& problem, const std::vector<bool>& trusted,
                             double gate, const LocalizeOptions& options,
                             const Placement& placement);

}  // namespace isotherm::network::detail
