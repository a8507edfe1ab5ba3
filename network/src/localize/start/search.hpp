#pragma once

#include <vector>

#include "localize/problem/map_task.hpp"

namespace isotherm::network::detail {

/// Pairs that the heat kernel does not find less likely than `chance` to be true ones; all if that
/// test is off or the network is one neighbourhood.
std::vector<bool> likely_pairs(const RangeProblem& problem, double chance,
                               const LocalizeOptions& options);

/// Of these pairs those whose ends have d neighbours in common: what no others hold in its place
/// may be a single false one that joins the far ends of a map. O(sum of squared degrees).
std::vector<bool> supported_pairs(const RangeProblem& problem, const std::vector<bool>& pairs);

/// The map of the highest objective that is found. A start is a map by shortest paths, unfolded by
/// springs: of the pairs that are likelier true than not and that others support; unless hardly a
/// trusted pair contradicts that one, of all that heat leaves, as ranges that may be too long, and
/// of those that the best map does not contradict, or of these those that others support. Each is
/// refined, and of two maps each part is taken from where it is likelier. So is what comes of
/// mirroring parts of the best map, unfolding it again as ranges of any length or too long, and
/// drawing regions of it anew, as long as that helps. Plain least squares has the first map as it
/// is. @throws Cancelled
Placement search_map(const MapTask& task, const Placement& anchors);

}  // namespace isotherm::network::detail
