#include "localize/refine/weigh_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localize/constants.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/refine/range_information.hpp"

namespace isotherm::network::detail {
namespace {

// Of a correct range's information: what weighs less is nothing beside rounding.
constexpr double kWeighs = 1e-6;

struct Residual {
  double error = 0.0;  // measured less predicted
  double noise = 0.0;  // variance of it, were it correct
};

Residual residual_of(const RangeProblem& problem, const Placement& placement,
                     const RangeMixture& model, std::size_t k) {
  const auto& range = problem.ranges[k];
  return {range.distance - distance_of(placement, range.from, range.to),
          std::pow(model.sigma(problem.sigmas[k]), 2)};
}

// Weights and evidence where the nodes are.
void assess(const RangeProblem& problem, const Absence& absence, const Placement& placement,
            WeighedRanges& weighed) {
  weighed.weighs.assign(problem.ranges.size(), false);
  weighed.information.assign(problem.ranges.size(), 0.0);
  double cost =
      log_prior_cost(weighed.model, typical_excess(problem.typical_sigma, weighed.model.longest),
                     weighed.too_long);
  for (std::size_t k = 0; k < problem.ranges.size(); ++k) {
    if (!is_placed(placement, problem.ranges[k])) continue;
    const auto [error, noise] = residual_of(problem, placement, weighed.model, k);
    const auto loss = range_loss(weighed.model, error, noise);
    cost += loss.cost;
    weighed.information[k] = loss.curvature;
    weighed.weighs[k] = loss.curvature * noise > kWeighs;
  }
  cost += 0.5 * absence_cost(problem, absence, placement);
  RangeInformation information(problem, weighed.weighs, placement, weighed.information);
  weighed.evidence = -cost - 0.5 * information.log_determinant();
}

WeighedRanges weigh(const RangeProblem& problem, const Absence& absence,
                    const LocalizeOptions& options, const RangeMixture& start, bool too_long,
                    Placement& placement) {
  WeighedRanges weighed;
  weighed.model = start;
  weighed.too_long = too_long;
  weighed.outcome = refine_mixture(problem, absence, too_long, options, weighed.model, placement);
  assess(problem, absence, placement, weighed);
  return weighed;
}

}  // namespace

WeighedRanges weigh_ranges(const RangeProblem& problem, const Absence& absence,
                           const LocalizeOptions& options, Placement& placement) {
  auto place_without = placement;
  const auto without_excess = first_mixture(problem, placement, false);
  auto with =
      weigh(problem, absence, options, first_mixture(problem, placement, true), true, placement);
  auto without = weigh(problem, absence, options, without_excess, false, place_without);
  if (with.evidence >= without.evidence) return with;
  placement = std::move(place_without);
  return without;
}

WeighedRanges weigh_ranges_again(const RangeProblem& problem, const Absence& absence,
                                 const LocalizeOptions& options, const WeighedRanges& before,
                                 Placement& placement) {
  return weigh(problem, absence, options, before.model, before.too_long, placement);
}

std::vector<JudgedRange> judge_ranges(const RangeProblem& problem, const WeighedRanges& weighed,
                                      const Placement& placement) {
  const auto variances = RangeInformation(problem, weighed.weighs, placement, weighed.information)
                             .predicted_variances();
  std::vector<JudgedRange> judged(problem.ranges.size());
  for (std::size_t k = 0; k < judged.size(); ++k) {
    if (!is_placed(placement, problem.ranges[k])) continue;
    const auto [error, noise] = residual_of(problem, placement, weighed.model, k);
    const auto loss = range_loss(weighed.model, error, noise);
    const double curvature = weighed.weighs[k] ? weighed.information[k] : 0.0;
    auto& range = judged[k];
    range.fits = loss.probability[kCorrect] >= kLikely;
    range.moments = range_moments(weighed.model, error, noise);
    range.fitted = std::min(1.0, curvature * variances[k]);
    const auto without = left_out(loss, error, noise, variances[k], curvature);
    if (!without.checked) continue;
    range.checked = true;
    range.loss = range_loss(weighed.model, without.error, without.variance);
  }
  return judged;
}

}  // namespace isotherm::network::detail
