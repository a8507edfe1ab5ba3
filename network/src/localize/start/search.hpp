#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Pairs that the heat kernel does not find less likely than `chance` to be true ones; all if that
/// test is off or the network is one neighbourhood.
std::vector<bool> likely_pairs(const RangeProblem& problem, double chance,
                               const LocalizeOptions& options);

/// The map of the highest objective that is found. Maps by
/// shortest paths are unfolded by springs, first of the pairs that are likelier true than not, then
/// of all that heat leaves, then of those that the best map does not contradict; each is settled
/// node by node and fold by fold. The best one is heated again as long as that helps. Plain least
/// squares has the first map as it is. @throws Cancelled
Placement search_map(const RangeProblem& problem, const Placement& anchors,
                     const std::vector<bool>& trusted, double gate, const LocalizeOptions& options);

}  // namespace isotherm::network::detail
