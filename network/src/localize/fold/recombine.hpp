#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/fold/part_move.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// The parts of a map that are elsewhere in another one of the same frame, as they are there:
/// connected nodes that are farther apart in both than noise, than twice that, and so on up to a
/// typical range. Each part once.
std::vector<PartMove> differing_parts(const RangeProblem& problem, const std::vector<bool>& trusted,
                                      const Placement& placement, const Placement& other);

/// Takes from another map of the same frame the parts that are likelier there, and refines the
/// map, as long as there are any; whether there were.
bool recombine(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
               const LocalizeOptions& options, const Placement& other, Placement& placement);

}  // namespace isotherm::network::detail
