#include "crowded_gate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isotherm::slam::detail {
namespace {

constexpr double kHalfOctave = std::numbers::sqrt2;
constexpr int kStepsPerOctave = 4;
constexpr int kOctaves = 5;
constexpr double kDeviations = 3.0;

// Whether `a` independent events are more than `b` by more than chance.
bool more(double a, double b) { return a - b > kDeviations * std::sqrt(a + b); }

}  // namespace

double crowded_gate(std::vector<double> chi2, double gate) {
  std::ranges::sort(chi2);
  const auto around = [&](double x) {
    return static_cast<double>(std::ranges::upper_bound(chi2, x * kHalfOctave) -
                               std::ranges::lower_bound(chi2, x / kHalfOctave));
  };
  const double beyond = around(gate * kHalfOctave);
  double valley = gate;
  double fewest = around(gate);
  for (int k = 1; k <= kOctaves * kStepsPerOctave; ++k) {
    const double x = gate * std::exp2(-static_cast<double>(k) / kStepsPerOctave);
    const double count = around(x);
    if (more(count, fewest)) break;
    if (count >= fewest) continue;
    fewest = count;
    valley = x;
  }
  return more(beyond, fewest) ? valley : gate;
}

}  // namespace isotherm::slam::detail
