#include "localize/refine/robust_refine.hpp"

#include <algorithm>
#include <cmath>

#include "localize/constants.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/evidence/relocate.hpp"

namespace isotherm::network::detail {
namespace {

double deviation_of(const RangeProblem& problem, const Placement& placement, std::size_t k) {
  const auto& range = problem.ranges[k];
  return std::abs(distance_of(placement, range.from, range.to) - range.distance) /
         problem.sigmas[k];
}

double median_deviation(const RangeProblem& problem, const Placement& placement) {
  std::vector<double> deviations;
  for (std::size_t k = 0; k < problem.ranges.size(); ++k) {
    if (is_placed(placement, problem.ranges[k])) {
      deviations.push_back(deviation_of(problem, placement, k));
    }
  }
  return deviations.empty() ? 0.0 : lower_median(std::move(deviations));
}

void refine_among(const RangeProblem& problem, const std::vector<bool>& use, double width,
                  const LocalizeOptions& options, Placement& placement) {
  constexpr int kIterations = 12;
  constexpr double kStill = 1e-4;  // the next width, or the polish, goes on from here
  refine(problem, use, placement,
         {.width = width,
          .max_iterations = kIterations,
          .still = kStill,
          .progress = options.progress});
}

}  // namespace

std::vector<bool> ranges_within(const RangeProblem& problem, const Placement& placement,
                                double gate) {
  std::vector<bool> within(problem.ranges.size(), false);
  for (std::size_t k = 0; k < within.size(); ++k) {
    within[k] = is_placed(placement, problem.ranges[k]) &&
                std::pow(deviation_of(problem, placement, k), 2) <= gate;
  }
  return within;
}

std::vector<bool> ranges_in_reach(const RangeProblem& problem, const std::vector<bool>& trusted,
                                  const Placement& placement, double width) {
  auto use = ranges_within(problem, placement, std::pow(kFarOutside * width, 2));
  for (std::size_t k = 0; k < use.size(); ++k) use[k] = use[k] && trusted[problem.pair_of[k]];
  return use;
}

void refine_at_width(const RangeProblem& problem, double width, const LocalizeOptions& options,
                     Placement& placement) {
  const auto use = ranges_within(problem, placement, std::pow(kFarOutside * width, 2));
  refine_among(problem, use, width, options, placement);
}

void refine_robustly(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                     const LocalizeOptions& options, Placement& placement) {
  constexpr int kMostRounds = 5;
  constexpr double kMedianOfNormal = 0.6745;
  const double narrow = std::sqrt(gate);
  const auto spread = [&] { return 2.0 * median_deviation(problem, placement) / kMedianOfNormal; };
  // Far from the minimum: by trusted pairs.
  for (double width = spread(); width > narrow; width = std::min(0.5 * width, spread())) {
    const auto use = ranges_in_reach(problem, trusted, placement, width);
    refine_among(problem, use, width, options, placement);
  }
  refine_at_width(problem, narrow, options, placement);
  std::vector<bool> among(problem.nodes, true);
  for (int round = 0; round < kMostRounds; ++round) {
    const auto evidence = learn_evidence(problem, trusted, placement);
    const auto moved = relocate(problem, gate, evidence, options, among, placement);
    if (moved.empty()) break;
    refine_at_width(problem, narrow, options, placement);
    among = within_steps(problem, moved, 1);  // whose surroundings have changed
  }
}

}  // namespace isotherm::network::detail
