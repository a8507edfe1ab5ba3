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

double ScaleShares::count() const { return sum_of(loops); }

double ScaleShares::log_evidence() const {
  const double before = sum_of(kPriorLoops);
  double log_probability = std::lgamma(before) - std::lgamma(before + count());
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    log_probability += log_rising(kPriorLoops[j], loops[j]);
  }
  return log_probability;
}

bool are_of_different_scales(double factor, double other) {
  return std::max(factor, other) >= kScaleStep * std::min(factor, other);
}

ScaleShift wider_most(const ScaleShares& shares) {
  const auto& [most, worse, worst, stated] = shares.loops;
  return {kScaleStep, {{most + worse, worst, 0.0, stated}}};
}

ScaleShift sharper_most(const ScaleShares& shares) {
  const auto& [most, worse, worst, stated] = shares.loops;
  return {1.0 / kScaleStep, {{0.5 * most, 0.5 * most, worse + worst, stated}}};
}

ScaleShares all_as_most(const ScaleShares& shares) {
  return {{sum_of(shares.loops), 0.0, 0.0, 0.0}};
}

ScaleShift all_as_worst(const ScaleShares& shares) {
  const auto& [most, worse, worst, stated] = shares.loops;
  return {kWorst, {{most + worse + worst, 0.0, 0.0, stated}}};
}

// What the file states is a scale of its own only beyond the worst of the others.
ScaleMixture expected_mixture(double scale, const ScaleShares& shares, double sharpest) {
  ScaleMixture mixture{.scale = scale, .relative = {1.0, kScaleStep, kWorst, 1.0 / scale}};
  ByScale expected = kPriorLoops;
  for (std::size_t j = 0; j < kScaleCount; ++j) expected[j] += shares.loops[j];
  const double all = sum_of(expected);
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    mixture.log_relative[j] = std::log(mixture.relative[j]);
    mixture.log_share[j] = std::log(expected[j] / all);
  }
  if (scale * sharpest * kWorst >= 1.0) {
    mixture.log_share[2] = std::log((expected[2] + expected[3]) / all);
    mixture.log_share[3] = kNever;
  }
  return mixture;
}

double ScaleMixture::share_of_worse() const { return 1.0 - std::exp(log_share.front()); }

ErrorScale error_scale(const ScaleMixture& mixture, const ByScale& log_density) {
  const double most = *std::ranges::max_element(log_density);
  double sum = 0.0;
  ErrorScale result{.weight = {0.0, 0.0}};
  auto& [probability, weight, evidence] = result;
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    probability[j] = mixture.has(j) ? std::exp(log_density[j] - most) : 0.0;
    sum += probability[j];
  }
  for (double& p : probability) p /= sum;
  for (std::size_t j = 0; j < kAsStated; ++j) weight.learnt += probability[j] / mixture.relative[j];
  weight.stated = probability[kAsStated];
  return result;
}

ErrorScale error_scale(const ScaleMixture& mixture, const Misfit& misfit) {
  ByScale log_determinant;
  ByScale log_density;
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    const bool stated = j == kAsStated;
    log_determinant[j] = stated ? misfit.log_stated : misfit.dof * mixture.log_relative[j];
    const double chi2 = stated ? misfit.stated : misfit.chi2 / mixture.relative[j];
    log_density[j] = mixture.log_share[j] - 0.5 * (log_determinant[j] + chi2);
  }
  ErrorScale result = error_scale(mixture, log_density);
  const auto likeliest = static_cast<std::size_t>(std::ranges::max_element(result.probability) -
                                                  result.probability.begin());
  const double log_sum = log_density[likeliest] - std::log(result.probability[likeliest]);
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    const double p = result.probability[j];
    if (p > 0.0) result.evidence -= p * (0.5 * log_determinant[j] + log_density[j] - log_sum);
  }
  return result;
}

}  // namespace isotherm::slam::detail
