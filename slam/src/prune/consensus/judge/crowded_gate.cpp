#include "prune/consensus/judge/crowded_gate.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "prune/consensus/calibrate/octave_counts.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kOctaves = 5;

// The middle of the emptiest octave on the way down from the gate.
double valley_below(double gate, const OctaveCounts& loops) {
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
  return valley;
}

}  // namespace

GateBySpan crowded_gate(const std::vector<SpannedChi2>& loops, double gate) {
  std::vector<double> all;
  std::array<std::vector<double>, kSpanClasses> classes;
  for (const auto& [span, chi2] : loops) {
    all.push_back(chi2);
    classes[span_class(span)].push_back(chi2);
  }
  GateBySpan gates;
  gates.fill(gate);
  const OctaveCounts counts(std::move(all));
  const double valley = valley_below(gate, counts);
  const double below = counts.around(valley);
  const double just_beyond = gate * std::numbers::sqrt2;
  const double beyond = counts.around(just_beyond);
  if (!more(beyond, below)) return gates;
  // A class with few loops leans on all of them.
  const double excess = (beyond - below) / (beyond + below);
  for (std::size_t k = 0; k < kSpanClasses; ++k) {
    const OctaveCounts of_class(std::move(classes[k]));
    if (of_class.around(just_beyond) + excess > of_class.around(valley)) {
      gates[k] = valley;
    }
  }
  return gates;
}

}  // namespace isotherm::slam::detail
