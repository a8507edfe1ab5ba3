#pragma once

#include <vector>

#include "isotherm/base/statistics.hpp"
#include "localize/problem/range_problem.hpp"

/// What the tests of the localiser's stages share.
namespace isotherm::network::detail {

/// Chi-squared of a range that fits, at most.
inline const double kGate = chi_squared_quantile(0.999, 1);

/// Every pair trusted.
inline std::vector<bool> all_of(const RangeProblem& problem) {
  return std::vector<bool>(problem.pairs.size(), true);
}

}  // namespace isotherm::network::detail
