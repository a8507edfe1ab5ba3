#pragma once

#include <functional>

#include "isotherm/spectral/edges/edge_verdicts.hpp"
#include "report/report.hpp"

namespace isotherm::apps {

/// Where a candidate comes from, besides what its verdict says.
struct CandidateSource {
  std::int32_t from = 0;  ///< position of a node
  std::int32_t to = 0;
  std::uint64_t line = 0;  ///< of the input file; 0 if there is none
};

/// The columns every kind of report has, from the verdicts in order.
ReportCandidates report_candidates(
    const spectral::EdgeVerdicts& verdicts,
    const std::function<CandidateSource(const spectral::EdgeVerdict&)>& source);

/// How many verdicts are within a factor of two of their threshold, either side.
std::int64_t close_calls(const spectral::EdgeVerdicts& verdicts);

/// "All options have their default values.", or which do not.
std::string options_in_words(const Json& options, const Json& defaults);

/// The counts of a run: "kept 250 loops, pruned 120 and left 1 undecided".
std::string counts_in_words(const spectral::EdgeVerdicts& verdicts, const ReportNouns& nouns);

}  // namespace isotherm::apps
