#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "isotherm/base/options.hpp"

namespace isotherm::spectral {

/// What is decided about a candidate edge.
enum class Verdict {
  keep,
  prune,
  ambiguous,  ///< not proven either way; left out unless the user asks otherwise
};

constexpr std::array<EnumName<Verdict>, 3> enum_names(Verdict) {
  return {{{Verdict::keep, "keep"}, {Verdict::prune, "prune"}, {Verdict::ambiguous, "ambiguous"}}};
}

/// A decision with its reason: the score that was compared, and with what.
struct EdgeVerdict {
  std::int64_t edge = 0;   ///< 0-based position among the edges of the input
  std::uint64_t from = 0;  ///< vertex ids as the input has them
  std::uint64_t to = 0;
  Verdict verdict = Verdict::keep;
  double score = 0.0;      ///< larger is more suspicious
  double threshold = 0.0;  ///< the edge is pruned where score > threshold
  std::string stage;       ///< scale, round or test that decided
  /// Of the edge being true, in [0, 1], where the method states one; else not a number.
  double probability = std::numeric_limits<double>::quiet_NaN();
};

/// One verdict per candidate, in order of `edge`.
using EdgeVerdicts = std::vector<EdgeVerdict>;

/// How many of `verdicts` equal `verdict`.
std::int64_t count(const EdgeVerdicts& verdicts, Verdict verdict);

/// Whether the method that decided stated a probability of any edge.
bool state_probabilities(const EdgeVerdicts& verdicts);

/// Whether the edge stays: where it is not proven either way, as asked.
bool stays(const EdgeVerdict& verdict, bool keep_ambiguous);

}  // namespace isotherm::spectral
