#include "prune/consensus/calibrate/octave_counts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace isotherm::slam::detail {
namespace {

constexpr double kHalfOctave = std::numbers::sqrt2;
constexpr double kOctaveDeviations = 3.0;

}  // namespace

OctaveCounts::OctaveCounts(std::vector<double> values) : values_(std::move(values)) {
  std::ranges::sort(values_);
}

double OctaveCounts::around(double x) const {
  return static_cast<double>(std::ranges::upper_bound(values_, x * kHalfOctave) -
                             std::ranges::lower_bound(values_, x / kHalfOctave));
}

std::size_t OctaveCounts::below(double x) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(values_, x) - values_.begin());
}

bool more(double a, double b) { return a - b > kOctaveDeviations * std::sqrt(a + b); }

}  // namespace isotherm::slam::detail
