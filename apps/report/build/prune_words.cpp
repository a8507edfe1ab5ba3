#include "report/build/prune_words.hpp"

#include <fmt/format.h>

#include "report/build/candidate_columns.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;
using spectral::Verdict;

std::string name_in_words(PruneMethod method) {
  switch (method) {
    case PruneMethod::consensus:
      return "Forward consensus";
    case PruneMethod::heat:
      return "Heat-kernel pruning";
    case PruneMethod::chi2:
      return "The chi-squared gate";
    case PruneMethod::lap_line:
      return "The comparison of curves";
    default:
      return fmt::format("Method {}", enum_name(method));
  }
}

std::string words_of_consensus(const ConsensusResult& result, const PruneOptions& options) {
  const double significance =
      options.significance > 0.0 ? options.significance : options.consensus.significance;
  return fmt::format(
      "Where errors are as the information matrices say, a correct loop is pruned with "
      "probability {}. About {:.0f} % of the loops that were decided are taken as correct. "
      "Covariances were scaled by {:.3g} for odometry and {:.3g} for loops to fit the data.",
      significance, 100.0 * result.inlier_fraction, result.odometry_scale, result.loop_scale);
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
  std::string text = fmt::format("{} {}, in {:.2f} s.", name_in_words(decisions.method),
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
  if (decisions.method == PruneMethod::consensus) {
    text += " " + words_of_consensus(decisions.consensus, options);
  }
  return text;
}

}  // namespace isotherm::apps
