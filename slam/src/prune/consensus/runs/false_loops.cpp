#include "prune/consensus/runs/false_loops.hpp"

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

/// How many of some loops are of a kind, as expected; of their share Beta(1, kFalseByChance).
struct Share {
  double count = 0.0;
  double all = 0.0;

  void add(double probability, double of = 1.0) {
    count += probability * of;
    all += of;
  }
  double log_yes() const { return std::log((1.0 + count) / (1.0 + kFalseByChance + all)); }
  double log_no() const {
    return std::log((kFalseByChance + all - count) / (1.0 + kFalseByChance + all));
  }
  double log_evidence() const {
    return std::lgamma(1.0 + count) + std::lgamma(kFalseByChance + all - count) -
           std::lgamma(1.0 + kFalseByChance + all) + std::log(kFalseByChance);
  }
};

/// How many follow the one before, and of the others are of the right place.
struct Shares {
  Share following;
  Share right;

  double log_alone(double log_place) const {
    return log_sum(right.log_no(), right.log_yes() + log_place);
  }
  double log_odds_of_right(double log_place) const {
    return right.log_yes() + log_place - right.log_no();
  }
  double log_odds_of_following(double log_led, double log_place) const {
    return following.log_yes() + log_led - following.log_no() - log_alone(log_place);
  }
  double log_evidence() const { return following.log_evidence() + right.log_evidence(); }
};

/// Loops that are not accepted, where shares are as `before`.
class Expected {
 public:
  explicit Expected(const Shares& before) : before_(before) {}

  // One that none leads.
  void add(double log_place, double probability = 1.0) {
    const double log_odds = before_.log_odds_of_right(log_place);
    const double is_right = probability_of(log_odds);
    found_.right.add(is_right, probability);
    evidence_ += probability * (is_right * log_place + entropy(log_odds));
  }

  void add_led(double log_led, double log_place) {
    const double log_odds = before_.log_odds_of_following(log_led, log_place);
    const double follows = probability_of(log_odds);
    found_.following.add(follows);
    evidence_ += follows * log_led + entropy(log_odds);
    add(log_place, 1.0 - follows);
  }

  const Shares& shares() const { return found_; }
  double log_evidence() const { return evidence_ + found_.log_evidence(); }

 private:
  Shares before_;
  Shares found_;
  double evidence_ = 0.0;
};

}  // namespace

double FalseLoops::log_alone(double log_place) const {
  return log_sum(log_chance, log_right + log_place);
}

template <class Pose>
FalseLoops false_loops(const Runs<Pose>& runs, const std::vector<bool>& accepted,
                       std::span<const double> log_led, std::span<const double> log_place) {
  const auto is_led = [&](std::size_t k) {
    const Index before = runs.leader(static_cast<Index>(k));
    return before != Runs<Pose>::kNone && !accepted[before];
  };
  FalseLoops found{.log_follows = std::vector<double>(accepted.size())};
  Shares shares;
  for (int step = 0; step < kShareSteps; ++step) {
    Expected expected(shares);
    for (std::size_t k = 0; k < accepted.size(); ++k) {
      if (accepted[k]) continue;
      is_led(k) ? expected.add_led(log_led[k], log_place[k]) : expected.add(log_place[k]);
    }
    shares = expected.shares();
    found.log_evidence = expected.log_evidence();
  }
  found.log_right = shares.right.log_yes();
  found.log_chance = shares.right.log_no();
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    if (accepted[k] || !is_led(k)) continue;
    const double led = shares.log_odds_of_following(log_led[k], log_place[k]);
    found.log_follows[k] = shares.following.log_no() + log_sum(0.0, led);
  }
  return found;
}

template FalseLoops false_loops(const Runs<Pose2>&, const std::vector<bool>&,
                                std::span<const double>, std::span<const double>);
template FalseLoops false_loops(const Runs<Pose3>&, const std::vector<bool>&,
                                std::span<const double>, std::span<const double>);

}  // namespace isotherm::slam::detail
