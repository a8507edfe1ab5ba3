#include "isotherm/spectral/edges/threshold.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSmallestRatio = 1e-12;  // to the largest distance, before taking logarithms

struct Moments {
  double mean = 0.0;
  double variance = 0.0;  // of the population
};

Moments moments(std::span<const double> values) {
  Moments result;
  const auto count = static_cast<double>(values.size());
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  for (const double value : values) result.variance += std::pow(value - result.mean, 2);
  result.variance /= count;
  return result;
}

/// Share of the variance that a split into the first `count` and the rest explains.
double explained_variance(std::span<const double> sorted, std::size_t count) {
  const auto all = moments(sorted);
  if (all.variance == 0.0 || count == 0 || count == sorted.size()) return 0.0;
  const auto low = moments(sorted.first(count));
  const auto high = moments(sorted.subspan(count));
  const double part = static_cast<double>(count) / static_cast<double>(sorted.size());
  return part * (1.0 - part) * std::pow(high.mean - low.mean, 2) / all.variance;
}

std::size_t count_at_most(std::span<const double> sorted, double value) {
  return std::upper_bound(sorted.begin(), sorted.end(), value) - sorted.begin();
}

/// Size of the lower class of the best split between different values (Otsu).
std::size_t otsu_split(std::span<const double> sorted) {
  const auto count = static_cast<double>(sorted.size());
  const double mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / count;
  double best = -1.0;
  std::size_t split = 0;
  double excess = 0.0;  // sum of (value - mean) over the lower class
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    excess += sorted[k - 1] - mean;
    if (sorted[k] == sorted[k - 1]) continue;
    const double part = static_cast<double>(k) / count;
    const double between = excess * excess / (part * (1.0 - part));
    if (between > best) {
      best = between;
      split = k;
    }
  }
  return split;
}

/// Size of the lower class when the split is at the widest gap.
std::size_t gap_split(std::span<const double> sorted) {
  std::size_t split = 1;
  for (std::size_t k = 2; k < sorted.size(); ++k) {
    if (sorted[k] - sorted[k - 1] > sorted[split] - sorted[split - 1]) split = k;
  }
  return split;
}

struct Component {
  double part = 0.5;
  double mean = 0.0;
  double variance = 1.0;

  double log_density(double x) const {
    return std::log(part) - 0.5 * std::log(2.0 * std::numbers::pi * variance) -
           0.5 * (x - mean) * (x - mean) / variance;
  }
};

/// Two normal components fitted by expectation maximisation from Otsu's split.
/// Variances are kept above a thousandth of the whole list's.
std::array<Component, 2> fit_mixture(std::span<const double> sorted) {
  constexpr int kMaxIterations = 200;
  constexpr double kTolerance = 1e-9;
  const double floor = 1e-3 * moments(sorted).variance;
  const auto count = static_cast<double>(sorted.size());
  std::vector<double> high(sorted.size(), 0.0);  // posterior of the upper component
  std::fill(high.begin() + otsu_split(sorted), high.end(), 1.0);

  std::array<Component, 2> components;
  double previous = -kInfinity;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    for (int side = 0; side < 2; ++side) {
      double mass = 0.0, mean = 0.0, variance = 0.0;
      const auto weight = [&](std::size_t k) { return side == 1 ? high[k] : 1.0 - high[k]; };
      for (std::size_t k = 0; k < sorted.size(); ++k) {
        mass += weight(k);
        mean += weight(k) * sorted[k];
      }
      mass = std::max(mass, 1e-9);
      mean /= mass;
      for (std::size_t k = 0; k < sorted.size(); ++k) {
        variance += weight(k) * (sorted[k] - mean) * (sorted[k] - mean);
      }
      components[side] = {mass / count, mean, std::max(variance / mass, floor)};
    }
    double likelihood = 0.0;
    for (std::size_t k = 0; k < sorted.size(); ++k) {
      const double low_log = components[0].log_density(sorted[k]);
      const double high_log = components[1].log_density(sorted[k]);
      const double larger = std::max(low_log, high_log);
      const double sum = std::exp(low_log - larger) + std::exp(high_log - larger);
      high[k] = std::exp(high_log - larger) / sum;
      likelihood += larger + std::log(sum);
    }
    if (likelihood - previous <= kTolerance * std::abs(likelihood)) break;
    previous = likelihood;
  }
  return components;
}

/// Where, between the two means, the upper component becomes the likelier one.
double mixture_boundary(const std::array<Component, 2>& components) {
  double low = components[0].mean;
  double high = components[1].mean;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double middle = 0.5 * (low + high);
    if (components[1].log_density(middle) > components[0].log_density(middle)) {
      high = middle;
    } else {
      low = middle;
    }
  }
  return high;
}

std::vector<double> logarithms(std::span<const double> sorted) {
  const double smallest = kSmallestRatio * sorted.back();
  std::vector<double> logs;
  logs.reserve(sorted.size());
  for (const double value : sorted) logs.push_back(std::log(std::max(value, smallest)));
  return logs;
}

Threshold mean_sigma(std::span<const double> sorted, double konst) {
  const auto all = moments(sorted);
  Threshold result{all.mean + konst * std::sqrt(all.variance), 0.0, false};
  result.separation = explained_variance(sorted, count_at_most(sorted, result.value));
  return result;
}

Threshold middle_of_split(std::span<const double> sorted, std::size_t split, bool in_logs) {
  const double middle = 0.5 * (sorted[split - 1] + sorted[split]);
  return {in_logs ? std::exp(middle) : middle, explained_variance(sorted, split), false};
}

}  // namespace

void ThresholdOptions::validate() const { require_fields_in_range(*this); }

Threshold find_threshold(std::span<const double> distances, const ThresholdOptions& options) {
  options.validate();
  for (std::size_t k = 0; k < distances.size(); ++k) {
    if (std::isfinite(distances[k]) && distances[k] >= 0.0) continue;
    throw InvalidArgument("distances[" + std::to_string(k) + "]",
                          "must be finite and not negative");
  }
  constexpr Threshold kNothingToSplit{kInfinity, 0.0, true};
  if (distances.empty()) return kNothingToSplit;
  std::vector<double> sorted(distances.begin(), distances.end());
  std::sort(sorted.begin(), sorted.end());
  if (options.rule == ThresholdRule::mean_sigma) return mean_sigma(sorted, options.konst);
  if (sorted.front() == sorted.back()) return kNothingToSplit;

  if (options.rule == ThresholdRule::otsu) {
    return middle_of_split(sorted, otsu_split(sorted), false);
  }
  const auto logs = logarithms(sorted);
  if (logs.front() == logs.back()) return kNothingToSplit;
  if (options.rule == ThresholdRule::gap) return middle_of_split(logs, gap_split(logs), true);
  const double boundary = mixture_boundary(fit_mixture(logs));
  return {std::exp(boundary), explained_variance(logs, count_at_most(logs, boundary)), false};
}

}  // namespace isotherm::spectral
