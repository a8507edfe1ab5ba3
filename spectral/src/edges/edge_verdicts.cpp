#include "isotherm/spectral/edges/edge_verdicts.hpp"

#include <algorithm>

namespace isotherm::spectral {

bool stays(const EdgeVerdict& verdict, bool keep_ambiguous) {
  return verdict.verdict == Verdict::keep ||
         (verdict.verdict == Verdict::ambiguous && keep_ambiguous);
}

std::int64_t count(const EdgeVerdicts& verdicts, Verdict verdict) {
  return std::count_if(verdicts.begin(), verdicts.end(),
                       [verdict](const EdgeVerdict& v) { return v.verdict == verdict; });
}

}  // namespace isotherm::spectral
