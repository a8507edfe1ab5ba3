#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Which placed nodes, with all that lies between them and the others, have one place
/// only: from a clique of agreeing ranges outwards, a node is firm if its next best place
/// among firm neighbours is less likely by the factor `options.mirror_chance`, and a map
/// of several nodes if that holds for its mirror images. A large part that hangs on the
/// rest by a thin neck, whose mirror image fits nearly as well, is not, however well its
/// nodes fit each other. With anchors, enough of them must be firm to fix the frame.
std::vector<bool> firm_nodes(const RangeProblem& problem, const std::vector<bool>& trusted,
                             double gate, const LocalizeOptions& options,
                             const Placement& placement);

}  // namespace isotherm::network::detail
