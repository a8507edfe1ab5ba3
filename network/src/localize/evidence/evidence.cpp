#include "localize/evidence/evidence.hpp"

#include <algorithm>
#include <cmath>

namespace isotherm::network::detail {
namespace {

// How ranges fit.
class Tally {
 public:
  void add(double residual, double gate) {
    if (residual * residual <= gate) {
      ++fitting_;
    } else {
      ++(residual > 0.0 ? apart_ : close_);
    }
  }

  Limits limits(const RangeProblem& problem) const {
    constexpr double kLeast = 4.0;
    constexpr double kPeak = 0.3989;  // of the standard normal density
    // A wrong range has any length up to about twice the usual one.
    const double span = 2.0 * problem.typical_distance / problem.typical_sigma;
    const auto limit = [&](double wrong) {
      return std::max(kLeast, 2.0 * std::log(fitting_ / wrong * kPeak * span));
    };
    return {limit(apart_), limit(close_)};
  }

 private:
  double fitting_ = 0.5;
  double apart_ = 0.5;
  double close_ = 0.5;
};

}  // namespace

Evidence learn_evidence(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                        const Placement& placement) {
  Tally tally;
  for (std::size_t p = 0; p < problem.pairs.size(); ++p) {
    const auto& pair = problem.pairs[p];
    if (trusted[p] && is_placed(placement, pair)) tally.add(deviation(placement, pair), gate);
  }
  return {Absence::learn(problem, trusted, placement), tally.limits(problem)};
}

Evidence learn_evidence(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                        const std::vector<Patch>& patches) {
  Tally tally;
  for (const auto& patch : patches) {
    const SmallNetwork network{patch.positions, 0, inner_ranges(problem, trusted, patch.members)};
    for (const auto& range : network.ranges) tally.add(deviation(network, range), gate);
  }
  return {Absence::learn(problem, trusted, patches), tally.limits(problem)};
}

}  // namespace isotherm::network::detail
