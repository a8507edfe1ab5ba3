#include "report/build/prune_words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "isotherm/base/words.hpp"
#include "report/build/candidate_columns.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;
using spectral::Verdict;

// A number of loops that need not be a whole one.
std::string expected_number(double number) {
  constexpr double kNegligible = 1e-3;
  return number < kNegligible ? fmt::format("fewer than {}", kNegligible)
                              : fmt::format("{:.2g}", number);
}

std::string words_of_probabilities(const spectral::EdgeVerdicts& verdicts,
                                   const ReportNouns& nouns) {
  double false_kept = 0.0;
  double true_pruned = 0.0;
  for (const auto& verdict : verdicts) {
    if (std::isnan(verdict.probability)) continue;
    if (verdict.verdict == Verdict::keep) false_kept += 1.0 - verdict.probability;
    if (verdict.verdict == Verdict::prune) true_pruned += verdict.probability;
  }
  const auto counted_as = [&](Verdict wanted) {
    return counted(static_cast<std::uint64_t>(count(verdicts, wanted)), nouns.edge, nouns.edges);
  };
  return fmt::format(
      "Verdicts are probabilities of being true, by all measurements together: among the {} that "
      "are kept {} are expected to be false, among the {} that are pruned {} to be true. {}.",
      counted_as(Verdict::keep), expected_number(false_kept), counted_as(Verdict::prune),
      expected_number(true_pruned),
      count(verdicts, Verdict::ambiguous) == 0
          ? "None is undecided"
          : fmt::format("Undecided: {}", counted_as(Verdict::ambiguous)));
}

// An ordinary finding up to one deviation of what is believed of files before, a factor of ten in
// the errors; beyond two the file says nothing.
std::string words_of_scale(std::string_view what, double scale) {
  const double deviations = prior_deviations(scale);
  if (deviations <= 1.0) return "";
  return deviations <= 2.0
             ? fmt::format(" Of {} the file is off by more than a factor of ten.", what)
             : fmt::format(
                   " What the file states of {} is meaningless, off by more than a factor "
                   "of a hundred: verdicts rest on what the data say of it.",
                   what);
}

std::string words_of_slips(const std::vector<OdometrySlip>& slips) {
  constexpr std::size_t kNamed = 5;
  if (slips.empty()) return "";
  std::string text = fmt::format(
      " Edges of odometry that err at least ten times as much as the others: {} (", slips.size());
  for (std::size_t k = 0; k < std::min(kNamed, slips.size()); ++k) {
    text += fmt::format("{}{} to {}", k == 0 ? "" : ", ", slips[k].from, slips[k].to);
  }
  return text + (slips.size() > kNamed ? ", …)." : ").");
}

// Of few axes, in their order.
std::string words_of_bias(const std::vector<double>& bias) {
  if (std::ranges::all_of(bias, [](double turn) { return turn == 0.0; })) return "";
  std::vector<std::string> turns;
  for (const double turn : bias) turns.push_back(fmt::format("{:.2g}", 1e3 * turn));
  return fmt::format(" In each step the robot turned by {} mrad more than odometry tells{}.",
                     fmt::join(turns, ", "), bias.size() > 1 ? " (about x, y, z)" : "");
}

std::string words_of_scales(const ConsensusResult& result) {
  std::string text = fmt::format(
      " Errors turn out to be {:.3g} times (odometry) and {:.3g} times (most loops) as large as "
      "the file states, those of rotation against translation {:.3g} times.",
      std::sqrt(result.odometry_scale), std::sqrt(result.loop_scale),
      std::sqrt(result.rotation_scale));
  if (result.share_of_worse >= 0.005) {
    text += fmt::format(" About {:.0f} % of the loops are less accurate than most.",
                        100.0 * result.share_of_worse);
  }
  return text + words_of_bias(result.odometry_bias) + words_of_slips(result.odometry_slips) +
         words_of_scale("the accuracy of odometry", result.odometry_scale) +
         words_of_scale("the accuracy of loops", result.loop_scale) +
         words_of_scale("the accuracy of rotation against translation", result.rotation_scale);
}

std::string words_of_consensus(const PruneResult& decisions, const ConsensusOptions& options,
                               const ReportNouns& nouns) {
  return words_of_probabilities(decisions.verdicts, nouns) +
         (options.calibrate ? words_of_scales(decisions.consensus)
                            : " The information of the file was taken at its word.");
}

}  // namespace

ReportRounds report_rounds(const PruneResult& decisions) {
  ReportRounds table;
  if (!decisions.consensus.moves.empty()) {
    table.columns = {"move", "accepted", "dropped", "in force"};
    for (const auto& move : decisions.consensus.moves) {
      table.rows.push_back({std::to_string(table.rows.size() + 1), std::to_string(move.accepted),
                            std::to_string(move.dropped), std::to_string(move.in_force)});
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

std::string words_of_certainty(const PruneResult& decisions, const PruneOptions& options,
                               const ReportNouns& nouns) {
  if (decisions.verdicts.empty()) return "There was nothing to decide.";
  const auto* consensus = std::get_if<ConsensusOptions>(&options);
  if (consensus != nullptr && decisions.method == ConsensusOptions::method()) {
    return words_of_consensus(decisions, *consensus, nouns);
  }
  return fmt::format("{} of {} scores are within a factor of two of their threshold.",
                     close_calls(decisions.verdicts), decisions.verdicts.size());
}

}  // namespace isotherm::apps
