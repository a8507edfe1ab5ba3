#include "isotherm/slam/prune/evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "prune/consensus/judge/log_odds.hpp"
#include "prune/evidence/climb/climb.hpp"

namespace isotherm::slam {
namespace {

using detail::Explanation;
using spectral::Verdict;

// Factors on the stated covariances of odometry and of loops to start from: one climb cannot leave
// a sharp scale that explains a few loops and refutes the rest, nor a wide one.
const std::array<detail::CovarianceScale, 6> kStarts = {
    {{1.0, 1.0}, {100.0, 1.0}, {0.01, 0.01}, {1.0, 0.01}, {100.0, 100.0}, {1.0, 100.0}}};
constexpr double kNegligible = 1e-9;  // weight of an explanation

// Of one that keeps every loop nothing is left to explain otherwise. Scales at which the normal
// equations break down explain nothing.
template <class Pose>
std::vector<Explanation<Pose>> explanations(detail::Climb<Pose>& climb, bool calibrate) {
  std::vector<Explanation<Pose>> found;
  for (const auto& start : kStarts) {
    try {
      found.push_back(climb.from(start));
    } catch (const NumericalError&) {
      if (found.empty() && &start == &kStarts.back()) throw;
      continue;
    }
    if (!calibrate || std::ranges::count(found.back().accepted, false) == 0) break;
  }
  return found;
}

double probability_of(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

// Of all explanations, by their evidence. One at about the scale of a better one that keeps the
// same loops is the same peak.
template <class Pose>
std::vector<double> probabilities(detail::Climb<Pose>& climb, std::vector<Explanation<Pose>> found,
                                  std::vector<detail::Standing>& best) {
  std::ranges::stable_sort(found, std::greater{}, &Explanation<Pose>::evidence);
  std::vector<double> sums;
  double weights = 0.0;
  for (auto at = found.begin(); at != found.end(); ++at) {
    const double weight = std::exp(at->evidence - found.front().evidence);
    const bool same = std::any_of(found.begin(), at, [&](const auto& better) {
      return better.accepted == at->accepted &&
             std::abs(std::log(better.scale.odometry / at->scale.odometry)) < 1.0;
    });
    if (same || weight < kNegligible) continue;
    const auto standings = climb.standings(*at);
    if (at == found.begin()) best = standings;
    sums.resize(standings.size());
    for (std::size_t k = 0; k < standings.size(); ++k) {
      sums[k] += weight * probability_of(standings[k].log_odds);
    }
    weights += weight;
  }
  for (double& sum : sums) sum /= weights;
  return sums;
}

Verdict verdict_of(bool accepted, double probability, double significance) {
  if (accepted && probability > 1.0 - significance) return Verdict::keep;
  return probability < significance ? Verdict::prune : Verdict::ambiguous;
}

std::string stage_of(bool accepted, const detail::Standing& standing) {
  if (accepted) return "accepted";
  return standing.connected ? "rejected" : "unconnected";
}

template <class Pose>
void report(detail::Climb<Pose>& climb, const std::vector<Explanation<Pose>>& found,
            double significance, EvidenceResult& result) {
  const auto& best = *std::ranges::max_element(found, {}, &Explanation<Pose>::evidence);
  std::vector<detail::Standing> standings;
  const auto probability = probabilities(climb, found, standings);
  const double decisive = detail::log_odds_of(1.0 - significance);
  result.details.resize(standings.size());
  for (std::size_t k = 0; k < standings.size(); ++k) {
    const auto& [connected, chi2, evidence, log_odds] = standings[k];
    auto& verdict = result.verdicts[k];
    verdict.score = -detail::log_odds_of(probability[k]);
    verdict.threshold = decisive;
    verdict.verdict = verdict_of(best.accepted[k], probability[k], significance);
    verdict.stage = stage_of(best.accepted[k], standings[k]);
    result.details[k] = {
        .probability = probability[k], .log_ratio = evidence, .chi2 = chi2, .connected = connected};
  }
  result.odometry_scale = best.scale.odometry;
  result.loop_scale = best.scale.loops;
  result.share_as_stated =
      std::exp(detail::expected_mixture(best.scale.loops, best.shares).log_share.back());
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
  const auto found = explanations(climb, options.calibrate);
  result.moves = climb.moves();
  result.settled = climb.settled();
  report(climb, found, options.significance, result);
  return result;
}

template EvidenceResult judge_by_evidence(const PoseGraph<Pose2>&, const EdgeRoles&,
                                          const EvidenceOptions&, const RunContext&);
template EvidenceResult judge_by_evidence(const PoseGraph<Pose3>&, const EdgeRoles&,
                                          const EvidenceOptions&, const RunContext&);

}  // namespace isotherm::slam
