#include "prune/consensus/objective/error_scales.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kWorst = kScaleStep * kScaleStep;
constexpr double kOther = kLoopsBefore / 3.0;
constexpr ByScale kPriorLoops = {kLoopsBefore, kOther, kOther, kOther};

// log (x (x + 1) ... (x + count - 1)), and between whole counts their mean: of all distributions of
// a count with this mean, that has the least.
double log_rising(double x, double count) {
  const double whole = std::floor(count);
  return std::lgamma(x + whole) - std::lgamma(x) + (count - whole) * std::log(x + whole);
}

double sum_of(const ByScale& loops) { return std::accumulate(loops.begin(), loops.end(), 0.0); }

}  // namespace

void ScaleShares::add(const ErrorScale& found) {
  for (std::size_t j = 0; j < kScaleCount; ++j) loops[j] += found.probability[j];
}

double ScaleShares::log_evidence() const {
  const double before = sum_of(kPriorLoops);
  double log_probability = std::lgamma(before) - std::lgamma(before + sum_of(loops));
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    log_probability += log_rising(kPriorLoops[j], loops[j]);
  }
  return log_probability;
}

bool are_of_different_scales(double weight, double other) {
  return std::max(weight, other) >= kScaleStep * std::min(weight, other);
}

ScaleShift wider_most(const ScaleShares& shares) {
  const auto& [most, worse, worst, stated] = shares.loops;
  return {kScaleStep, {{most + worse, worst, 0.0, stated}}};
}

ScaleShift sharper_most(const ScaleShares& shares) {
  const auto& [most, worse, worst, stated] = shares.loops;
  return {1.0 / kScaleStep, {{0.5 * most, 0.5 * most, worse + worst, stated}}};
}

ScaleShift all_as_worst(const ScaleShares& shares) {
  const auto& [most, worse, worst, stated] = shares.loops;
  return {kWorst, {{most + worse + worst, 0.0, 0.0, stated}}};
}

// What the file states is a scale of its own only beyond the worst of the others.
ScaleMixture expected_mixture(double scale, const ScaleShares& shares) {
  ScaleMixture mixture{.scale = scale, .relative = {1.0, kScaleStep, kWorst, 1.0 / scale}};
  ByScale expected = kPriorLoops;
  for (std::size_t j = 0; j < kScaleCount; ++j) expected[j] += shares.loops[j];
  const double all = sum_of(expected);
  for (std::size_t j = 0; j < kScaleCount; ++j) mixture.log_share[j] = std::log(expected[j] / all);
  if (mixture.relative[3] <= kWorst) {
    mixture.relative[3] = kWorst;
    mixture.log_share[2] = std::log((expected[2] + expected[3]) / all);
    mixture.log_share[3] = kNever;
  }
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    mixture.log_relative[j] = std::log(mixture.relative[j]);
  }
  return mixture;
}

double ScaleMixture::share_of_worse() const { return 1.0 - std::exp(log_share.front()); }

ErrorScale error_scale(const ScaleMixture& mixture, const ByScale& log_density, double dof) {
  const double most = *std::ranges::max_element(log_density);
  double sum = 0.0;
  ErrorScale result{.weight = 0.0};
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    result.probability[j] = mixture.has(j) ? std::exp(log_density[j] - most) : 0.0;
    sum += result.probability[j];
  }
  const double log_all = most + std::log(sum);
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    double& p = result.probability[j];
    p /= sum;
    result.weight += p / mixture.relative[j];
    if (p == 0.0) continue;
    result.evidence -= p * (0.5 * dof * mixture.log_relative[j] + log_density[j] - log_all);
  }
  return result;
}

ErrorScale error_scale(const ScaleMixture& mixture, double chi2, double dof) {
  ByScale log_density;
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    log_density[j] =
        mixture.log_share[j] - 0.5 * (dof * mixture.log_relative[j] + chi2 / mixture.relative[j]);
  }
  return error_scale(mixture, log_density, dof);
}

}  // namespace isotherm::slam::detail
