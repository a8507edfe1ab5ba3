#include "report/build/candidate_columns.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace isotherm::apps {

using spectral::EdgeVerdict;
using spectral::EdgeVerdicts;
using spectral::Verdict;

ReportCandidates report_candidates(
    const EdgeVerdicts& verdicts,
    const std::function<CandidateSource(const EdgeVerdict&)>& source) {
  ReportCandidates all;
  std::map<std::string, std::uint32_t> stages;
  for (const auto& verdict : verdicts) {
    const auto [from, to, line] = source(verdict);
    all.edge.push_back(static_cast<std::uint32_t>(verdict.edge));
    all.from.push_back(from);
    all.to.push_back(to);
    all.line.push_back(static_cast<std::uint32_t>(line));
    all.verdict.push_back(static_cast<std::uint8_t>(verdict.verdict));
    all.score.push_back(static_cast<float>(verdict.score));
    all.threshold.push_back(static_cast<float>(verdict.threshold));
    const auto next = static_cast<std::uint32_t>(all.stages.size());
    const auto [stage, is_new] = stages.emplace(verdict.stage, next);
    if (is_new) all.stages.push_back(verdict.stage);
    all.stage.push_back(stage->second);
  }
  return all;
}

std::int64_t close_calls(const EdgeVerdicts& verdicts) {
  return std::ranges::count_if(verdicts, [](const EdgeVerdict& verdict) {
    return verdict.score > 0.5 * verdict.threshold && verdict.score < 2.0 * verdict.threshold;
  });
}

std::string options_in_words(const Json& options, const Json& defaults) {
  std::string changed;
  for (const auto& [name, value] : options.items()) {
    if (defaults.contains(name) && defaults[name] == value) continue;
    changed += fmt::format("{}{} = {}", changed.empty() ? "" : ", ", name,
                           value.is_string() ? value.get<std::string>() : value.dump());
  }
  return changed.empty() ? "All options have their default values."
                         : fmt::format(
                               "Set for this run: {}. All other options have their "
                               "default values.",
                               changed);
}

std::string counts_in_words(const EdgeVerdicts& verdicts, const ReportNouns& nouns) {
  const auto ambiguous = count(verdicts, Verdict::ambiguous);
  return fmt::format("kept {} {}, pruned {} and left {} undecided", count(verdicts, Verdict::keep),
                     nouns.edges, count(verdicts, Verdict::prune),
                     ambiguous == 0 ? "none" : std::to_string(ambiguous));
}

}  // namespace isotherm::apps
