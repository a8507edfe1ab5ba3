#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// What the ranges in `use` between placed nodes determine, whatever their lengths:
/// `localised` (or `anchor`) for nodes with one possible place, else what is missing.
/// Nodes that are not placed are not_placed.
///
/// Unique placement needs d + 1 neighbours that are themselves unique, rigidity, and
/// rigidity after the loss of any one range (B. Hendrickson, "Conditions for unique
/// graph realizations", 1992); rigidity is that of the framework at `placement`,
/// which must be in general position. His other condition, (d + 1)-connectivity, is
/// only checked for single nodes. @throws NumericalError
std::vector<NodeStatus> determinacy(const RangeProblem& problem, const std::vector<bool>& use,
                                    const Placement& placement);

/// The same for all nodes, with those that are no anchors at random positions.
std::vector<NodeStatus> generic_determinacy(const RangeProblem& problem,
                                            const std::vector<bool>& use, const Placement& anchors);

}  // namespace isotherm::network::detail
