#include "prune/consensus/runs/false_runs.hpp"

#include <cmath>

#include "prune/consensus/constants.hpp"
#include "prune/consensus/log_odds.hpp"
#include "prune/consensus/log_sum.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kShareSteps = 30;

// -p log p - (1 - p) log(1 - p), by the log odds.
double entropy(double log_odds) {
  const double p = probability_of(log_odds);
  return log_sum(0.0, -log_odds) + (1.0 - p) * log_odds;
}

}  // namespace

template <class Pose>
FalseRuns false_runs(const Runs<Pose>& runs, const std::vector<bool>& accepted,
                     std::span<const double> log_led) {
  std::vector<std::size_t> loops;
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    const Index before = runs.leader(static_cast<Index>(k));
    if (before != Runs<Pose>::kNone && !accepted[k] && !accepted[before]) loops.push_back(k);
  }
  const auto all = static_cast<double>(loops.size());
  double follow = all;
  double gain = 0.0;
  for (int step = 0; step < kShareSteps; ++step) {
    const double log_share_odds = std::log((1.0 + follow) / (kFalseAlone + all - follow));
    follow = gain = 0.0;
    for (const std::size_t k : loops) {
      const double log_odds = log_share_odds + log_led[k];
      const double p = probability_of(log_odds);
      follow += p;
      gain += p * log_led[k] + entropy(log_odds);
    }
  }
  FalseRuns found{std::vector<double>(accepted.size()), gain};
  found.log_evidence += std::lgamma(1.0 + follow) + std::lgamma(kFalseAlone + all - follow) -
                        std::lgamma(1.0 + kFalseAlone + all) + std::log(kFalseAlone);
  const double share = (1.0 + follow) / (1.0 + kFalseAlone + all);
  for (const std::size_t k : loops) {
    found.log_follows[k] = log_sum(std::log1p(-share), std::log(share) + log_led[k]);
  }
  return found;
}

template FalseRuns false_runs(const Runs<Pose2>&, const std::vector<bool>&,
                              std::span<const double>);
template FalseRuns false_runs(const Runs<Pose3>&, const std::vector<bool>&,
                              std::span<const double>);

}  // namespace isotherm::slam::detail
