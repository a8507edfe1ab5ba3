#include "prune/consensus/runs/false_loops.hpp"

#include <cmath>

#include "prune/consensus/constants.hpp"
#include "prune/consensus/log_sum.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kShareSteps = 30;

/// Loops that follow none, as expected, and what is expected of their shares then: those of the
/// right place are Beta(1, kFalseByChance) before any is seen.
struct Counts {
  double right = 0.0;
  double chance = 0.0;

  double log_right() const { return std::log((1.0 + right) / all()); }
  double log_chance() const { return std::log((kFalseByChance + chance) / all()); }
  double all() const { return 1.0 + kFalseByChance + right + chance; }
  double log_evidence() const {
    return std::lgamma(1.0 + right) + std::lgamma(kFalseByChance + chance) - std::lgamma(all()) +
           std::log(kFalseByChance);
  }
};

}  // namespace

double FalseLoops::log_alone(double log_place) const {
  return log_sum(log_chance, log_right + log_place);
}

template <class Pose>
FalseLoops false_loops(const Runs<Pose>& runs, const std::vector<bool>& accepted,
                       std::span<const double> log_led, std::span<const double> log_place) {
  const double log_other = std::log1p(-kFalseFollowing);
  FalseLoops found{.log_follows = std::vector<double>(accepted.size())};
  Counts counts;
  for (int step = 0; step < kShareSteps; ++step) {
    found.log_right = counts.log_right();
    found.log_chance = counts.log_chance();
    found.log_evidence = 0.0;
    counts = {};
    for (std::size_t k = 0; k < accepted.size(); ++k) {
      if (accepted[k]) continue;
      const double alone = found.log_alone(log_place[k]);
      const Index before = runs.leader(static_cast<Index>(k));
      const bool led = before != Runs<Pose>::kNone && !accepted[before];
      auto& follows = found.log_follows[k];
      if (led) follows = log_sum(log_other, std::log(kFalseFollowing) + log_led[k] - alone);
      const double is_alone = led ? std::exp(log_other - follows) : 1.0;
      counts.right += is_alone * std::exp(found.log_right + log_place[k] - alone);
      counts.chance += is_alone * std::exp(found.log_chance - alone);
      found.log_evidence += alone + follows;
    }
    found.log_evidence +=
        counts.log_evidence() - counts.right * found.log_right - counts.chance * found.log_chance;
  }
  return found;
}

template FalseLoops false_loops(const Runs<Pose2>&, const std::vector<bool>&,
                                std::span<const double>, std::span<const double>);
template FalseLoops false_loops(const Runs<Pose3>&, const std::vector<bool>&,
                                std::span<const double>, std::span<const double>);

}  // namespace isotherm::slam::detail
