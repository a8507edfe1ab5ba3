#include "localize/evidence/agreement.hpp"

#include <algorithm>

namespace isotherm::network::detail {

Agreement agreement(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                    const Placement& placement) {
  Agreement result;
  for (std::size_t p = 0; p < problem.pairs.size(); ++p) {
    const auto& pair = problem.pairs[p];
    if (!trusted[p] || !is_placed(placement, pair)) continue;
    const double squared = squared_deviation(placement, pair);
    result.cost += std::min(gate, squared);
    if (squared <= gate) ++result.fitting;
    ++result.pairs;
  }
  const auto spare = result.pairs - problem.dimension * placed_count(placement);
  result.credit = gate * static_cast<double>(spare) - result.cost;
  return result;
}

}  // namespace isotherm::network::detail
