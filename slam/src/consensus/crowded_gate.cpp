#include "crowded_gate.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "octave_counts.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kOctaves = 5;

}  // namespace

double crowded_gate(std::vector<double> chi2, double gate) {
  const OctaveCounts loops(std::move(chi2));
  const double beyond = loops.around(gate * std::numbers::sqrt2);
  double valley = gate;
  double fewest = loops.around(gate);
  for (int k = 1; k <= kOctaves * kStepsPerOctave; ++k) {
    const double x = gate * std::exp2(-static_cast<double>(k) / kStepsPerOctave);
    const double count = loops.around(x);
    if (more(count, fewest)) break;
    if (count >= fewest) continue;
    fewest = count;
    valley = x;
  }
  return more(beyond, fewest) ? valley : gate;
}

}  // namespace isotherm::slam::detail
