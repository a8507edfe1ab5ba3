#include "prune/consensus/objective/error_scales.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace isotherm::slam::detail {
namespace {

constexpr double kPriorLoops = 1.0;  // of each kind

double found_and_prior(const ByScale& loops) {
  return std::accumulate(loops.begin(), loops.end(), kPriorLoops * kScaleCount);
}

}  // namespace

double ScaleShares::log_evidence() const {
  double log_probability =
      std::lgamma(kPriorLoops * kScaleCount) - std::lgamma(found_and_prior(loops));
  for (const double found : loops) {
    log_probability += std::lgamma(kPriorLoops + found) - std::lgamma(kPriorLoops);
  }
  return log_probability;
}

ScaleMixture expected_mixture(double scale, const ScaleShares& shares) {
  ScaleMixture mixture{.scale = scale, .relative = {1.0, std::max(1.0, 1.0 / scale)}};
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    mixture.log_share[j] =
        std::log((kPriorLoops + shares.loops[j]) / found_and_prior(shares.loops));
  }
  return mixture;
}

ErrorScale error_scale(const ScaleMixture& mixture, const ByScale& log_density, double dof) {
  const double most = *std::ranges::max_element(log_density);
  double sum = 0.0;
  for (const double value : log_density) sum += std::exp(value - most);
  ErrorScale result{.weight = 0.0};
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    const double p = std::exp(log_density[j] - most) / sum;
    result.probability[j] = p;
    result.weight += p / mixture.relative[j];
    if (p > 0.0) result.evidence -= p * (0.5 * dof * std::log(mixture.relative[j]) + std::log(p));
  }
  return result;
}

ErrorScale error_scale(const ScaleMixture& mixture, double chi2, double dof) {
  ByScale log_density;
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    log_density[j] = mixture.log_share[j] -
                     0.5 * (dof * std::log(mixture.relative[j]) + chi2 / mixture.relative[j]);
  }
  return error_scale(mixture, log_density, dof);
}

}  // namespace isotherm::slam::detail
