#include "isotherm/slam/prune/evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "prune/consensus/judge/log_odds.hpp"
#include "prune/evidence/climb/climb.hpp"

namespace isotherm::slam {
namespace {

using detail::CovarianceScale;
using detail::Explanation;
using spectral::Verdict;

// Factors on the stated covariances of odometry and of loops to start from: one climb cannot
// leave a sharp scale that explains a few loops and refutes the rest, nor a wide one.
const std::array<CovarianceScale, 4> kStarts = {
    {{1.0, 1.0}, {100.0, 1.0}, {0.01, 0.01}, {1.0, 0.01}}};

// Of one that keeps every loop nothing is left to explain otherwise. Scales at which the normal
// equations break down explain nothing.
template <class Pose>
Explanation<Pose> best_explanation(detail::Climb<Pose>& climb, bool calibrate) {
  std::optional<Explanation<Pose>> best;
  for (const CovarianceScale& start : kStarts) {
    try {
      auto found = climb.from(start);
      if (!best || found.evidence > best->evidence) best = std::move(found);
    } catch (const NumericalError&) {
      if (!best && &start == &kStarts.back()) throw;
      continue;
    }
    if (!calibrate || std::ranges::count(best->accepted, false) == 0) break;
  }
  return std::move(*best);
}

Verdict verdict_of(bool accepted, double log_odds, double decisive) {
  if (accepted && log_odds > decisive) return Verdict::keep;
  return log_odds < -decisive ? Verdict::prune : Verdict::ambiguous;
}

std::string stage_of(bool accepted, const detail::Standing& standing) {
  if (accepted) return "accepted";
  return standing.connected ? "rejected" : "unconnected";
}

template <class Pose>
void report(const Explanation<Pose>& best, const std::vector<detail::Standing>& standings,
            double significance, EvidenceResult& result) {
  const double decisive = detail::log_odds_of(1.0 - significance);
  result.details.resize(standings.size());
  for (std::size_t k = 0; k < standings.size(); ++k) {
    const auto& [connected, chi2, evidence, log_odds] = standings[k];
    auto& verdict = result.verdicts[k];
    verdict.score = -log_odds;
    verdict.threshold = decisive;
    verdict.verdict = verdict_of(best.accepted[k], log_odds, decisive);
    verdict.stage = stage_of(best.accepted[k], standings[k]);
    auto& detail = result.details[k];
    detail.chi2 = chi2;
    detail.log_ratio = evidence;
    detail.probability = 1.0 / (1.0 + std::exp(-log_odds));
    detail.connected = connected;
  }
  result.odometry_scale = best.scale.odometry;
  result.loop_scale = best.scale.loops;
  result.tail_dof = best.nu;
  result.log_evidence = best.evidence;
}

}  // namespace

void EvidenceOptions::validate() const {
  if (!(significance > 0.0 && significance < 0.5)) {
    throw InvalidArgument("significance", "must be in (0, 0.5)");
  }
  if (window <= 0) throw InvalidArgument("window", "must be positive");
  if (max_rounds <= 0) throw InvalidArgument("max_rounds", "must be positive");
}

template <class Pose>
EvidenceResult judge_by_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                 const EvidenceOptions& options, const RunContext& run) {
  options.validate();
  EvidenceResult result;
  result.verdicts = candidate_verdicts(graph, roles);
  if (roles.candidates.empty()) return result;
  const auto reduced = detail::reduce(graph, roles);
  const detail::Objective<Pose> objective(reduced, options.window);
  detail::Climb<Pose> climb(objective, options, run.progress);
  const auto best = best_explanation(climb, options.calibrate);
  result.moves = climb.moves();
  result.settled = climb.settled();
  report(best, climb.standings(best), options.significance, result);
  return result;
}

template EvidenceResult judge_by_evidence(const PoseGraph<Pose2>&, const EdgeRoles&,
                                          const EvidenceOptions&, const RunContext&);
template EvidenceResult judge_by_evidence(const PoseGraph<Pose3>&, const EdgeRoles&,
                                          const EvidenceOptions&, const RunContext&);

}  // namespace isotherm::slam
