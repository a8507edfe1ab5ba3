#include "prune/consensus/search/report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prune/consensus/constants.hpp"
#include "prune/consensus/log_odds.hpp"
#include "prune/consensus/log_sum.hpp"

namespace isotherm::slam::detail {
namespace {

// Each loop's log odds by all explanations, by their evidence; the best is first.
template <class Pose>
std::vector<double> mean_log_odds(const std::vector<Explanation<Pose>>& found) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  std::vector<double> log_true(found.front().standings.size(), kNone);
  std::vector<double> log_false = log_true;
  for (const auto& one : found) {
    const double log_weight = one.evidence - found.front().evidence;
    for (std::size_t k = 0; k < log_true.size(); ++k) {
      const double log_odds = one.standings[k].log_odds;
      log_true[k] = log_sum(log_true[k], log_weight - log_sum(0.0, -log_odds));
      log_false[k] = log_sum(log_false[k], log_weight - log_sum(0.0, log_odds));
    }
  }
  for (std::size_t k = 0; k < log_true.size(); ++k) log_true[k] -= log_false[k];
  return log_true;
}

}  // namespace

spectral::Verdict verdict_of(bool accepted, double log_odds, double decisive, bool refutable) {
  if (accepted && log_odds > decisive) return spectral::Verdict::keep;
  return log_odds < -decisive && refutable ? spectral::Verdict::prune
                                           : spectral::Verdict::ambiguous;
}

bool can_refute(std::size_t accepted) { return accepted >= kFewLoops; }

const char* stage_of(bool accepted, bool connected) {
  if (accepted) return "accepted";
  return connected ? "rejected" : "unconnected";
}

template <class Pose>
void report(const std::vector<Explanation<Pose>>& found, double significance,
            ConsensusResult& result) {
  const auto& best = found.front();
  const auto& standings = best.standings;
  const auto log_odds = mean_log_odds(found);
  const double decisive = log_odds_of(1.0 - significance);
  const bool refuting = can_refute(best.accepted_count());
  for (std::size_t k = 0; k < standings.size(); ++k) {
    auto& verdict = result.verdicts[k];
    verdict.score = -log_odds[k];
    verdict.threshold = decisive;
    verdict.verdict =
        verdict_of(best.accepted[k], log_odds[k], decisive, refuting && standings[k].connected());
    verdict.stage = stage_of(best.accepted[k], standings[k].connected());
    verdict.probability = probability_of(log_odds[k]);
    result.details.push_back({.probability = verdict.probability,
                              .evidence = standings[k].evidence,
                              .chi2 = standings[k].chi2,
                              .connected = standings[k].connected()});
  }
  result.odometry_scale = best.scale.odometry;
  result.loop_scale = best.scale.loops;
  for (int d = 0; d < Pose::kDof; ++d) {
    result.odometry_scales.push_back(best.scale.odometry * best.shapes.odometry[d]);
    result.loop_scales.push_back(best.scale.loops * best.shapes.loops[d]);
  }
  result.odometry_bias.assign(best.shapes.bias.begin(), best.shapes.bias.end());
  result.rotation_scale = rotation_against_translation<Pose>(best.shapes.loops);
  result.share_of_worse = best.mixture().share_of_worse();
  result.log_evidence = best.evidence;
}

template void report(const std::vector<Explanation<Pose2>>&, double, ConsensusResult&);
template void report(const std::vector<Explanation<Pose3>>&, double, ConsensusResult&);

}  // namespace isotherm::slam::detail
