#include "isotherm/spectral/edges/edge_verdicts.hpp"

#include <algorithm>
#include <cmath>

namespace isotherm::spectral {

bool state_probabilities(const EdgeVerdicts& verdicts) {
  return std::any_of(verdicts.begin(), verdicts.end(),
                     [](const EdgeVerdict& v) { return !std::isnan(v.probability); });
}

bool stays(const EdgeVerdict& verdict, bool keep_ambiguous) {
  return verdict.verdict == Verdict::keep ||
         (verdict.verdict == Verdict::ambiguous && keep_ambiguous);
}

std::int64_t count(const EdgeVerdicts& verdicts, Verdict verdict) {
  return std::count_if(verdicts.begin(), verdicts.end(),
                       [verdict](const EdgeVerdict& v) { return v.verdict == verdict; });
}

}  // namespace isotherm::spectral
