#include "localize/evidence/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "localize/evidence/crowd.hpp"

namespace isotherm::network::detail {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// Of a normal error of this deviation, at its peak.
double peak(double sigma) { return 1.0 / (sigma * std::sqrt(2.0 * std::numbers::pi)); }

double longest_range(const RangeProblem& problem) {
  double longest = 0.0;
  for (const auto& range : problem.ranges) longest = std::max(longest, range.distance);
  return longest;
}

RangeMixture learn_kinds_of(const MapTask& task, const Placement& placement) {
  constexpr int kRounds = 10;
  const double sigma = task.problem.typical_sigma;
  auto model = first_mixture(task.problem, placement, true);
  for (int round = 0; round < kRounds; ++round) {
    RangeStatistics statistics;
    task.visit_pairs(placement, [&](const RangePair& pair) {
      const double error = -pair.sigma * deviation(placement, pair);
      statistics.add(range_moments(model, error, pair.sigma * pair.sigma));
    });
    learn_kinds(statistics, typical_excess(sigma, model.longest), sigma, true, model);
  }
  return model;
}

}  // namespace

double RangeCost::operator()(double residual) const {
  const double cost = std::min(residual * residual, anything);
  return residual < 0.0 ? std::min(cost, too_long - per_sigma * residual) : cost;
}

double RangeCost::apart_at(double cost) const { return cost < anything ? std::sqrt(cost) : kNever; }

double RangeCost::close_at(double cost) const {
  if (cost >= anything) return kNever;
  const double excess = too_long < cost ? (cost - too_long) / per_sigma : 0.0;
  return std::max(std::sqrt(cost), excess);
}

RangeCost Evidence::cost_of(double sigma) const {
  RangeCost cost;
  const auto& share = model.share;
  const auto beside = [&](double density) {
    return std::max(0.0, 2.0 * std::log(share[kCorrect] * peak(sigma) / density));
  };
  cost.anything = beside(share[kAnything] / model.longest);
  if (share[kTooLong] > 0.0) {
    cost.too_long = beside(share[kTooLong] / model.excess);
    cost.per_sigma = 2.0 * sigma / model.excess;
  }
  return cost;
}

RangeMixture first_mixture(const RangeProblem& problem, const Placement& placement, bool too_long) {
  RangeMixture model;
  model.longest = extent(placement);
  model.longest = std::max(model.longest, longest_range(problem));
  if (!(model.longest > 0.0)) model.longest = 1.0;
  model.excess = typical_excess(problem.typical_sigma, model.longest);
  if (!too_long) leave_out_too_long(model);
  return model;
}

Evidence learn_evidence(const MapTask& task, const Placement& placement) {
  return {learn_kinds_of(task, placement), Absence::learn(task.problem, task.trusted, placement)};
}

double worth(const MapTask& task, const Placement& placement) {
  return worth(task, learn_evidence(task, placement), placement);
}

double worth(const MapTask& task, const Evidence& evidence, const Placement& placement) {
  const RangeProblem& problem = task.problem;
  const double correct = evidence.model.share[kCorrect] * longest_range(problem);
  double sum = -absence_cost(problem, evidence.absence, placement);
  task.visit_pairs(placement, [&](const RangePair& pair) {
    sum += 2.0 * std::log(correct * peak(pair.sigma));
    sum -= evidence.cost_of(pair.sigma)(deviation(placement, pair));
  });
  const double coordinates = problem.dimension * placed_count(placement);
  return sum - coordinates * 2.0 * std::log(evidence.model.longest * peak(problem.typical_sigma));
}

}  // namespace isotherm::network::detail
