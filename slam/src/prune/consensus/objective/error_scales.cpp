#include "prune/consensus/objective/error_scales.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double prior_loops(std::size_t scale) {
  return scale == 0 ? kLoopsBefore : kLoopsBefore / (kScaleCount - 1);
}

double relative_variance(std::size_t scale) {
  return std::pow(kScaleStep, static_cast<double>(scale));
}

// log (x (x + 1) ... (x + count - 1)), and between whole counts their mean: of all distributions of
// a count with this mean, that has the least.
double log_rising(double x, double count) {
  const double whole = std::floor(count);
  return std::lgamma(x + whole) - std::lgamma(x) + (count - whole) * std::log(x + whole);
}

double sum_of(const ByScale& loops) { return std::accumulate(loops.begin(), loops.end(), 0.0); }

// Loops of a scale but the stated one called of another.
template <class Renamed>
ScaleShares renamed(const ScaleShares& shares, const Renamed& name) {
  ScaleShares next;
  for (std::size_t j = 0; j <= kWorst; ++j) next.loops[name(j)] += shares.loops[j];
  next.loops[kAsStated] = shares.loops[kAsStated];
  return next;
}

}  // namespace

void ScaleShares::add(const ErrorScale& found) {
  for (std::size_t j = 0; j < kScaleCount; ++j) loops[j] += found.probability[j];
}

double ScaleShares::log_evidence() const {
  constexpr double before = 2.0 * kLoopsBefore;
  double log_probability = std::lgamma(before) - std::lgamma(before + sum_of(loops));
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    log_probability += log_rising(prior_loops(j), loops[j]);
  }
  return log_probability;
}

bool are_of_different_scales(double factor, double other) {
  return std::max(factor, other) >= kScaleStep * std::min(factor, other);
}

ScaleShift wider_most(const ScaleShares& shares) {
  return {kScaleStep, renamed(shares, [](std::size_t j) { return j == 0 ? j : j - 1; })};
}

ScaleShift sharper_most(const ScaleShares& shares) {
  ScaleShares next = renamed(shares, [](std::size_t j) { return std::min(j + 1, kWorst); });
  next.loops[0] = 0.5 * shares.loops[0];
  next.loops[1] -= next.loops[0];
  return {1.0 / kScaleStep, next};
}

ScaleShift all_as_worst(const ScaleShares& shares) {
  return {relative_variance(kWorst), renamed(shares, [](std::size_t) { return std::size_t{0}; })};
}

// What the file states is a scale of its own only beyond the worst of the others.
ScaleMixture expected_mixture(double scale, const ScaleShares& shares, double sharpest) {
  ScaleMixture mixture{.scale = scale};
  ByScale expected = shares.loops;
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    mixture.relative[j] = j == kAsStated ? 1.0 / scale : relative_variance(j);
    expected[j] += prior_loops(j);
  }
  const bool nearer = scale * sharpest * relative_variance(kWorst) >= 1.0;
  if (nearer) expected[kWorst] += std::exchange(expected[kAsStated], 0.0);
  const double all = sum_of(expected);
  for (std::size_t j = 0; j < kScaleCount; ++j) mixture.log_share[j] = std::log(expected[j] / all);
  if (nearer) mixture.log_share[kAsStated] = kNever;
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
    log_determinant[j] = stated ? misfit.log_stated : misfit.dof * std::log(mixture.relative[j]);
    const double chi2 = stated ? misfit.stated : misfit.chi2 / mixture.relative[j];
    log_density[j] = mixture.log_share[j] - 0.5 * (log_determinant[j] + chi2);
  }
  ErrorScale result = error_scale(mixture, log_density);
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    const double p = result.probability[j];
    if (p > 0.0) result.evidence -= p * (0.5 * log_determinant[j] + std::log(p));
  }
  return result;
}

}  // namespace isotherm::slam::detail
