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

bool both_placed(const RangeProblem& problem, const Placement& placement, std::size_t k) {
  return placement.placed[problem.ranges[k].from] && placement.placed[problem.ranges[k].to];
}

double median_deviation(const RangeProblem& problem, const Placement& placement) {
  std::vector<double> deviations;
  for (std::size_t k = 0; k < problem.ranges.size(); ++k) {
    if (both_placed(problem, placement, k)) {
      deviations.push_back(deviation_of(problem, placement, k));
    }
  }
  return deviations.empty() ? 0.0 : lower_median(std::move(deviations));
}

RefineOutcome refine_among(const RangeProblem& problem, const std::vector<bool>& use, double width,
                           int max_iterations, const LocalizeOptions& options,
                           Placement& placement) {
  constexpr double kStill = 1e-4;  // the next width, or the leave-one-out tests, go on from here
  return refine(problem, use, placement,
                {.width = width,
                 .max_iterations = max_iterations,
                 .still = kStill,
                 .progress = options.progress});
}

class Stages {
 public:
  Stages(const RangeProblem& problem, const std::vector<bool>& trusted, Placement& placement,
         const LocalizeOptions& options)
      : problem_(problem), trusted_(trusted), placement_(placement), options_(options) {}

  // Far from the minimum: by trusted pairs.
  void approach(double width) {
    const auto use = ranges_in_reach(problem_, trusted_, placement_, width);
    note(refine_among(problem_, use, width, kIterations, options_, placement_));
  }

  void fit(double width) {
    note(refine_at_width(problem_, width, kIterations, options_, placement_));
  }

  const RefineOutcome& total() const { return total_; }

 private:
  static constexpr int kIterations = 12;

  void note(const RefineOutcome& outcome) {
    total_.iterations += outcome.iterations;
    total_.converged = outcome.converged;
  }

  const RangeProblem& problem_;
  const std::vector<bool>& trusted_;
  Placement& placement_;
  const LocalizeOptions& options_;
  RefineOutcome total_;
};

}  // namespace

std::vector<bool> ranges_within(const RangeProblem& problem, const Placement& placement,
                                double gate) {
  std::vector<bool> within(problem.ranges.size(), false);
  for (std::size_t k = 0; k < within.size(); ++k) {
    within[k] = both_placed(problem, placement, k) &&
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

RefineOutcome refine_at_width(const RangeProblem& problem, double width, int max_iterations,
                              const LocalizeOptions& options, Placement& placement) {
  const auto use = ranges_within(problem, placement, std::pow(kFarOutside * width, 2));
  return refine_among(problem, use, width, max_iterations, options, placement);
}

RefineOutcome refine_robustly(const RangeProblem& problem, const std::vector<bool>& trusted,
                              double gate, const LocalizeOptions& options, Placement& placement) {
  constexpr int kMostRounds = 5;
  constexpr double kMedianOfNormal = 0.6745;
  const double narrow = std::sqrt(gate);
  Stages stages(problem, trusted, placement, options);
  const auto spread = [&] { return 2.0 * median_deviation(problem, placement) / kMedianOfNormal; };
  for (double width = spread(); width > narrow; width = std::min(0.5 * width, spread())) {
    stages.approach(width);
  }
  stages.fit(narrow);
  std::vector<bool> among(problem.nodes, true);
  for (int round = 0; round < kMostRounds; ++round) {
    const auto evidence = learn_evidence(problem, trusted, placement);
    const auto moved = relocate(problem, gate, evidence, options, among, placement);
    if (moved.empty()) break;
    stages.fit(narrow);
    among = within_steps(problem, moved, 1);  // whose surroundings have changed
  }
  return stages.total();
}

}  // namespace isotherm::network::detail
