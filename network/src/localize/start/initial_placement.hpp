#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Pairs that the heat kernel does not suspect (all, if that test is off).
std::vector<bool> trusted_pairs(const RangeProblem& problem, const LocalizeOptions& options);

/// A first place for as many nodes as possible. A map by shortest paths over the pairs that
/// local maps bear out is brought, part by part, into the frame of at least d + 1 anchors that fix
/// it (without anchors only the largest is placed), completed by growing and refined; parts
/// whose mirror image fits better are mirrored, and what is not firm is placed anew from what is,
/// as long as that helps. If too few nodes are firm then, a map by all trusted pairs, and the
/// better of both unfolded once more, are mended alike; the one whose firm nodes explain most
/// is taken. Plain least squares has the first start, unmended.
Placement place_initially(const RangeProblem& problem, const Placement& anchors,
                          const std::vector<bool>& trusted, double gate,
                          const LocalizeOptions& options);

}  // namespace isotherm::network::detail
