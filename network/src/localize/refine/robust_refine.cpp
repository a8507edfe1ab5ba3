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

void refine_among(const MapTask& task, const std::vector<bool>& use, double width,
                  Placement& placement) {
  constexpr int kIterations = 12;
  constexpr double kStill = 1e-4;  // the next width, or the polish, goes on from here
  refine(task.problem, use, placement,
         {.width = width,
          .max_iterations = kIterations,
          .still = kStill,
          .progress = task.options.progress});
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

std::vector<bool> ranges_in_reach(const MapTask& task, const Placement& placement, double width) {
  auto use = ranges_within(task.problem, placement, std::pow(kFarOutside * width, 2));
  for (std::size_t k = 0; k < use.size(); ++k) {
    use[k] = use[k] && task.trusted[task.problem.pair_of[k]];
  }
  return use;
}

void refine_at_width(const MapTask& task, double width, Placement& placement) {
  const auto use = ranges_within(task.problem, placement, std::pow(kFarOutside * width, 2));
  refine_among(task, use, width, placement);
}

void refine_robustly(const MapTask& task, Placement& placement) {
  constexpr int kMostRounds = 5;
  constexpr double kMedianOfNormal = 0.6745;
  const RangeProblem& problem = task.problem;
  const double narrow = std::sqrt(task.gate);
  const auto spread = [&] { return 2.0 * median_deviation(problem, placement) / kMedianOfNormal; };
  // Far from the minimum: by trusted pairs.
  for (double width = spread(); width > narrow; width = std::min(0.5 * width, spread())) {
    refine_among(task, ranges_in_reach(task, placement, width), width, placement);
  }
  refine_at_width(task, narrow, placement);
  std::vector<bool> among(problem.nodes, true);
  for (int round = 0; round < kMostRounds; ++round) {
    const auto moved = relocate(task, learn_evidence(task, placement), among, placement);
    if (moved.empty()) break;
    refine_at_width(task, narrow, placement);
    among = within_steps(problem, moved, 1);  // whose surroundings have changed
  }
}

}  // namespace isotherm::network::detail
