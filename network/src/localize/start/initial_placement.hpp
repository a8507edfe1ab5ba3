#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Pairs that the heat kernel does not suspect (all, if that test is off).
std::vector<bool> trusted_pairs(const RangeProblem& problem, const LocalizeOptions& options);

/// A first place for as many nodes as possible. Patches of trusted pairs are stitched,
/// each part is refined on its own, brought into the frame of at least d + 1 anchors that
/// fix it (without anchors only the largest is placed) and grown. If too few nodes are firm
/// then, maps by shortest paths, stitched patches unfolded and, if there is no fair one, maps
/// grown from cliques are tried too; the start whose firm nodes explain more is taken, and what
/// is not firm is placed anew from what is, as long as that helps. Plain least squares has the
/// stitched start as it is.
Placement place_initially(const RangeProblem& problem, const Placement& anchors,
                          const std::vector<bool>& trusted, double gate,
                          const LocalizeOptions& options);

}  // namespace isotherm::network::detail
