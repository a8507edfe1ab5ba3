#include "report/build/prune_words.hpp"

#include <variant>

#include <fmt/format.h>

#include "report/build/candidate_columns.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;
using spectral::Verdict;

std::string words_of_consensus(const ConsensusResult& result, const ConsensusOptions& options) {
  return fmt::format(
      "Where errors are as the information matrices say, a correct loop is pruned with "
      "probability {}. About {:.0f} % of the loops that were decided are taken as correct. "
      "Covariances were scaled by {:.3g} for odometry and {:.3g} for loops to fit the data.",
      options.significance, 100.0 * result.inlier_fraction, result.odometry_scale,
      result.loop_scale);
}

}  // namespace

ReportRounds report_rounds(const PruneResult& decisions) {
  ReportRounds table;
  if (!decisions.consensus.rounds.empty()) {
    table.columns = {"round", "rule", "accepted", "dropped", "in force"};
    for (const auto& round : decisions.consensus.rounds) {
      table.rows.push_back({std::to_string(table.rows.size() + 1), round.rule,
                            std::to_string(round.accepted), std::to_string(round.dropped),
                            std::to_string(round.in_force)});
    }
  } else if (!decisions.rounds.empty()) {
    table.columns = {"scale t", "loops", "pruned", "threshold", "separation"};
    for (const auto& round : decisions.rounds) {
      table.rows.push_back({fmt::format("{}", round.scale), std::to_string(round.candidates),
                            std::to_string(round.pruned), fmt::format("{:.4g}", round.threshold),
                            fmt::format("{:.3f}", round.separation)});
    }
  }
  return table;
}

std::string words_of_decisions(const PruneResult& decisions, const ReportNouns& nouns,
                               bool keep_ambiguous) {
  std::string text =
      fmt::format("{} {}, in {:.2f} s.", method_title(prune_method(decisions.method)),
                  counts_in_words(decisions.verdicts, nouns), decisions.seconds);
  if (count(decisions.verdicts, Verdict::ambiguous) > 0) {
    text += keep_ambiguous ? " The undecided ones stay in the map."
                           : " The undecided ones are left out of the map.";
  }
  return text;
}

std::string words_of_certainty(const PruneResult& decisions, const PruneOptions& options) {
  if (decisions.verdicts.empty()) return "There was nothing to decide.";
  std::string text = fmt::format("{} of {} scores are within a factor of two of their threshold.",
                                 close_calls(decisions.verdicts), decisions.verdicts.size());
  const auto* consensus = std::get_if<ConsensusOptions>(&options);
  if (consensus != nullptr && decisions.method == ConsensusOptions::method()) {
    text += " " + words_of_consensus(decisions.consensus, *consensus);
  }
  return text;
}

}  // namespace isotherm::apps
