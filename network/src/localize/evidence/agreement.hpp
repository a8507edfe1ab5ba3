#pragma once

#include <cstddef>
#include <vector>

#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// How well the trusted pairs of placed nodes fit a placement.
struct Agreement {
  std::ptrdiff_t pairs = 0;
  std::ptrdiff_t fitting = 0;  ///< of these, within the gate
  double cost = 0.0;           ///< sum of min(r^2, gate)
  /// By how much, in chi-squared, the pairs are explained more than the coordinates of
  /// the nodes could explain in any case.
  double credit = 0.0;

  double cost_per_pair() const { return pairs > 0 ? cost / static_cast<double>(pairs) : 0.0; }
};

Agreement agreement(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                    const Placement& placement);

}  // namespace isotherm::network::detail
