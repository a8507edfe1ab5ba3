#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Maps, in frames of their own, grown from cliques until these are all inside one or
/// there are a dozen; the largest first. Each is the best of several that were started in
/// different places: a map that folds early on stays folded.
std::vector<Placement> grown_parts(const RangeProblem& problem, const std::vector<bool>& trusted,
                                   double gate, const Evidence& evidence,
                                   const LocalizeOptions& options);

}  // namespace isotherm::network::detail
