#pragma once

#include <vector>

#include "localize/problem/map_task.hpp"

namespace isotherm::network::detail {

/// Which placed nodes have one place only: the most of them of which each one's second-best place
/// among the others is less likely by the factor `options.mirror_chance`, and no part of them has a
/// mirror image of which that is not true. Nodes that have another place are taken out, and then
/// those that hung on them.
std::vector<bool> firm_nodes(const MapTask& task, const Placement& placement);

}  // namespace isotherm::network::detail
