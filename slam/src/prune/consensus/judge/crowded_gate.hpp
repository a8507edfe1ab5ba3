#pragma once

#include <array>
#include <vector>

#include "prune/consensus/judge/span_class.hpp"

namespace isotherm::slam::detail {

using spectral::Index;

/// A gate for the chi-squared of loops of each class of spans (span_class).
using GateBySpan = std::array<double, kSpanClasses>;

/// How a loop lies.
struct SpannedChi2 {
  Index span = 0;  ///< vertices between its ends
  double chi2 = 0.0;
};

/// Where the chi-squared of true loops end and those of false ones begin: at most `gate`.
///
/// On a logarithmic scale true loops become fewer towards the gate and false ones more. If
/// far more lie just beyond the gate than in the emptiest octave below it, that octave's
/// middle, otherwise `gate`: for the classes of spans of which there are more beyond as well.
/// False loops between near poses crowd there, where those between far ones are far off.
/// O(n log n) for n loops.
GateBySpan crowded_gate(const std::vector<SpannedChi2>& loops, double gate);

}  // namespace isotherm::slam::detail
