#include "isotherm/network/localize/range_mixture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "localize/constants.hpp"

namespace isotherm::network {
namespace {

using std::numbers::pi;

// A factor of ten: the deviation of everything that has a scale and nothing is known of.
constexpr double kFactorOfTen = std::numbers::ln10;

// A range whose prediction without it has more than so many times its own variance is checked by
// nothing: rounding of the system's inverse.
constexpr double kUnchecked = 1e-6;

// log of exp(z^2) erfc(z).
double log_scaled_erfc(double z) {
  constexpr double kFar = 20.0;  // erfc is denormal from about 26
  if (z < kFar) return z * z + std::log(std::erfc(z));
  const double inverse = 1.0 / (2.0 * z * z);
  return std::log1p(-inverse * (1.0 - 3.0 * inverse)) - std::log(z * std::sqrt(pi));
}

double normal_cost(double error, double sigma) {
  const double z = error / sigma;
  return 0.5 * z * z + std::log(sigma) + 0.5 * std::log(2.0 * pi);
}

// Of a scale, by the log of its ratio to what is expected.
double log_normal_cost(double log_value) {
  const double z = log_value / kFactorOfTen;
  return 0.5 * z * z + std::log(kFactorOfTen) + 0.5 * std::log(2.0 * pi);
}

// A normal error and an exponential excess: -log density and its derivatives. The normal part has,
// given the sum, a normal distribution cut off above: `cut` deviations from its mean.
struct Excess {
  double cost;
  double cut;
  double hazard;  // density at the cut by the probability below it
};

Excess excess_of(double error, double sigma, double mean) {
  Excess result{};
  result.cut = error / sigma - sigma / mean;
  const double z = -result.cut / std::numbers::sqrt2;
  // Both forms are exact; each keeps its precision on its side.
  const double log_tail = z > 0.0 ? log_scaled_erfc(z) - z * z : std::log(std::erfc(z));
  result.cost =
      std::log(2.0 * mean) - 0.5 * (sigma / mean) * (sigma / mean) + error / mean - log_tail;
  result.hazard = std::exp(-0.5 * result.cut * result.cut - 0.5 * std::log(2.0 * pi) - log_tail +
                           std::numbers::ln2);
  return result;
}

// log of the most likely standard deviation of so many values with this sum of squares, with a
// normal prior around `centre`.
double most_likely_log_sigma(double count, double squares, double centre) {
  const double precision = 1.0 / (kFactorOfTen * kFactorOfTen);
  double x = count > 0.0 && squares > 0.0 ? 0.5 * std::log(squares / count) : centre;
  x = std::clamp(x, centre - 20.0, centre + 20.0);
  for (int i = 0; i < 50; ++i) {
    const double fit = squares * std::exp(-2.0 * x);
    const double slope = count - fit + precision * (x - centre);
    const double step = slope / (2.0 * fit + precision);
    x -= std::clamp(step, -1.0, 1.0);
    if (std::abs(step) < 1e-12) break;
  }
  return x;
}

// The same of the mean of exponential values.
double most_likely_log_mean(double count, double sum, double centre) {
  const double precision = 1.0 / (kFactorOfTen * kFactorOfTen);
  double x = centre;
  for (int i = 0; i < 100; ++i) {
    const double fit = sum * std::exp(-x);
    const double slope = count - fit + precision * (x - centre);
    const double step = slope / (fit + precision);
    x -= std::clamp(step, -1.0, 1.0);
    if (std::abs(step) < 1e-12) break;
  }
  return x;
}

}  // namespace

double typical_excess(double sigma, double longest) { return std::sqrt(sigma * longest); }

void leave_out_too_long(RangeMixture& model) {
  model.share[kCorrect] += model.share[kTooLong];
  model.share[kTooLong] = 0.0;
}

namespace {

// An excess that no range has is not looked at.
Excess excess_if_any(const RangeMixture& model, double error, double sigma) {
  return model.share[kTooLong] > 0.0 ? excess_of(error, sigma, model.excess) : Excess{};
}

RangeLoss loss_of(const RangeMixture& model, const Excess& excess, double error, double variance) {
  const double sigma = std::sqrt(variance);
  ByKind cost{};
  ByKind slope{};
  ByKind curvature{};
  cost[kCorrect] = normal_cost(error, sigma);
  slope[kCorrect] = error / variance;
  curvature[kCorrect] = 1.0 / variance;
  cost[kAnything] = std::log(model.longest);
  if (model.share[kTooLong] > 0.0) {
    cost[kTooLong] = excess.cost;
    slope[kTooLong] = 1.0 / model.excess - excess.hazard / sigma;
    curvature[kTooLong] = excess.hazard * (excess.hazard + excess.cut) / variance;
  }
  RangeLoss result;
  double least = INFINITY;
  for (std::size_t kind = 0; kind < kRangeKinds; ++kind) {
    cost[kind] -= std::log(model.share[kind]);
    least = std::min(least, cost[kind]);
  }
  double sum = 0.0;
  for (std::size_t kind = 0; kind < kRangeKinds; ++kind) {
    result.probability[kind] = std::exp(least - cost[kind]);
    sum += result.probability[kind];
  }
  result.cost = least - std::log(sum);
  for (std::size_t kind = 0; kind < kRangeKinds; ++kind) {
    result.probability[kind] /= sum;
    result.slope += result.probability[kind] * slope[kind];
    result.curvature += result.probability[kind] * std::max(curvature[kind], 0.0);
  }
  return result;
}

}  // namespace

RangeLoss range_loss(const RangeMixture& model, double error, double variance) {
  return loss_of(model, excess_if_any(model, error, std::sqrt(variance)), error, variance);
}

const char* name_of(const RangeLoss& loss) {
  const auto& p = loss.probability;
  if (p[kCorrect] >= p[kTooLong] && p[kCorrect] >= p[kAnything]) return "correct";
  return p[kTooLong] >= p[kAnything] ? "too long" : "false";
}

LeftOutRange left_out(const RangeLoss& loss, double error, double noise, double predicted,
                      double curvature) {
  const double rest = 1.0 - curvature * predicted;
  if (rest < kUnchecked) return {};
  const double without = predicted / rest;
  return {error + without * loss.slope, noise + without, true};
}

RangeMoments range_moments(const RangeMixture& model, double error, double variance) {
  RangeMoments moments;
  const double sigma = std::sqrt(variance);
  const auto excess = excess_if_any(model, error, sigma);
  moments.probability = loss_of(model, excess, error, variance).probability;
  moments.squared_noise = moments.probability[kCorrect] * error * error / variance;
  if (model.share[kTooLong] > 0.0) {
    const double noise = sigma / model.excess - excess.hazard;  // its mean, in deviations
    const double spread = std::max(0.0, 1.0 - excess.hazard * (excess.hazard + excess.cut));
    moments.squared_noise += moments.probability[kTooLong] * (noise * noise + spread);
    moments.excess = moments.probability[kTooLong] * std::max(0.0, error - sigma * noise);
  }
  return moments;
}

void RangeStatistics::add(const RangeMoments& moments) {
  for (std::size_t kind = 0; kind < kRangeKinds; ++kind) count[kind] += moments.probability[kind];
  squared_noise += moments.squared_noise;
  excess += moments.excess;
}

void learn_kinds(const RangeStatistics& statistics, double typical_excess, double sigma,
                 bool too_long, RangeMixture& model) {
  const auto& count = statistics.count;
  const double kinds = too_long ? 3.0 : 2.0;
  const double all = count[kCorrect] + count[kTooLong] + count[kAnything] + kinds;
  for (std::size_t kind = 0; kind < kRangeKinds; ++kind) {
    model.share[kind] = (count[kind] + 1.0) / all;
  }
  if (!too_long) model.share[kTooLong] = 0.0;
  if (too_long) {
    const double likeliest = std::exp(
        most_likely_log_mean(count[kTooLong], statistics.excess, std::log(typical_excess)));
    // An excess that noise hides is noise.
    model.excess = std::max(likeliest, detail::kHardlyNoise * sigma);
  }
}

double most_likely_scale(const RangeStatistics& statistics, double fitted, double scale) {
  const auto& count = statistics.count;
  const double normal = std::max(0.0, count[kCorrect] + count[kTooLong] - fitted);
  // In units of the scale so far.
  const double squares = statistics.squared_noise * scale * scale;
  return std::exp(most_likely_log_sigma(normal, squares, 0.0));
}

double most_likely_variance(double squares, double redundancy) {
  return std::exp(2.0 * most_likely_log_sigma(redundancy, squares, 0.0));
}

double log_scale_cost(double variance) { return log_normal_cost(0.5 * std::log(variance)); }

double log_prior_cost(const RangeMixture& model, double typical_excess, bool too_long) {
  // Dirichlet's distribution after one range of each kind.
  double cost = log_normal_cost(std::log(model.scale)) - std::log(too_long ? 120.0 : 6.0);
  for (std::size_t kind = 0; kind < kRangeKinds; ++kind) {
    if (kind != kTooLong || too_long) cost -= std::log(model.share[kind]);
  }
  if (too_long) cost += log_normal_cost(std::log(model.excess / typical_excess));
  return cost;
}

}  // namespace isotherm::network
