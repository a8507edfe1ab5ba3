#include "prune/evidence/climb/climb.hpp"

#include <algorithm>
#include <cmath>

#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "prune/evidence/climb/groups.hpp"
#include "prune/evidence/climb/learn_scales.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kSteps = 4;           // of Gauss-Newton at given weights
constexpr int kReweighings = 3;     // of loops, by Student's distribution
constexpr double kSettled = 0.05;   // of a log weight or scale
constexpr int kMostDrops = 1;       // a loop dropped so often at given scales is not tried again
constexpr int kLearnings = 12;      // of the scales in one climb
constexpr double kHopeless = 50.0;  // log odds against, by a bound, beyond which none is solved for
constexpr double kRefuted = 1e-4;   // share of correct loops farther out than one that is refuted
constexpr double kBetter = 0.1;     // nats by which an explanation must be better to go on
constexpr std::array kTails = {3.0, 5.0, 10.0, 20.0, 50.0, kGaussian};

bool differ(double a, double b) { return std::abs(std::log(a / b)) > kSettled; }

}  // namespace

template <class Pose>
Climb<Pose>::Climb(const Objective<Pose>& objective, const EvidenceOptions& options,
                   const ProgressCallback& progress)
    : objective_(objective),
      graph_(objective.graph()),
      options_(options),
      progress_(progress),
      estimate_(graph_),
      odometry_(estimate_.layout()),
      refuting_chi2_(chi_squared_quantile(1.0 - kRefuted, Pose::kDof)),
      standings_(graph_.loops.size()),
      covariances_(graph_.loops.size()) {}

template <class Pose>
void Climb<Pose>::start(const CovarianceScale& scale) {
  const std::size_t loops = graph_.loops.size();
  now_ = {.accepted = std::vector<bool>(loops, false), .scale = scale};
  now_.weights.assign(loops, 1.0);
  drops_.assign(loops, 0);
  estimate_.restore(odometry_);
  forget_bounds();
}

template <class Pose>
Explanation<Pose> Climb<Pose>::from(const CovarianceScale& scale) {
  start(scale);
  grow();
  now_.evidence = evidence();
  Explanation<Pose> best = now_;
  best.layout = estimate_.layout();
  for (int k = 0; options_.calibrate && k < kLearnings; ++k) {
    if (!rescale()) break;
    std::ranges::fill(drops_, 0);
    grow();
    now_.evidence = evidence();
    if (now_.evidence < best.evidence + kBetter) break;
    best = now_;
    best.layout = estimate_.layout();
  }
  return best;
}

template <class Pose>
std::vector<Standing> Climb<Pose>::standings(const Explanation<Pose>& explanation) {
  now_ = explanation;
  estimate_.restore(explanation.layout);
  forget_bounds();
  estimate();
  weigh();
  return standings_;
}

template <class Pose>
void Climb<Pose>::grow() {
  for (int round = 0; round < options_.max_rounds; ++round) {
    tell_progress();
    estimate();
    weigh();
    Selection out = misfits();
    const Selection batch = out.empty() ? next_batch() : Selection();
    if (out.empty() && batch.empty()) return;
    for (const Index k : out) {
      now_.accepted[k] = false;
      now_.weights[k] = 1.0;
      ++drops_[k];
    }
    for (const Index k : batch) now_.accepted[k] = true;
    if (!out.empty()) forget_bounds();
    moves_.push_back({.accepted = static_cast<std::int64_t>(batch.size()),
                      .dropped = static_cast<std::int64_t>(out.size()),
                      .in_force = std::ranges::count(now_.accepted, true)});
  }
  settled_ = false;
}

// The peak: weights and poses in turn.
template <class Pose>
void Climb<Pose>::estimate() {
  int reweighed = 0;
  do {
    estimate_.weigh_loops(now_.weights);
    estimate_.update(now_.accepted, now_.scale, kSteps);
  } while (reweighed++ < kReweighings && reweigh_loops());
}

// Whether any weight changed.
template <class Pose>
bool Climb<Pose>::reweigh_loops() {
  if (now_.nu >= kGaussian) return false;
  bool changed = false;
  for (std::size_t k = 0; k < now_.accepted.size(); ++k) {
    if (!now_.accepted[k]) continue;
    const auto& link = graph_.loops[k];
    const typename Pose::Tangent r = estimate_.residual(link);
    const double weight =
        student_weight(r.dot(link.information * r) / now_.scale.loops, now_.nu, Pose::kDof);
    changed = changed || differ(weight, now_.weights[k]);
    now_.weights[k] = weight;
  }
  return changed;
}

template <class Pose>
void Climb<Pose>::weigh() {
  near_ = objective_.near(estimate_.poses());
  weigh_accepted();
  weigh_others();
  add_prior();
}

template <class Pose>
void Climb<Pose>::weigh_accepted() {
  Selection loops;
  for (std::size_t k = 0; k < now_.accepted.size(); ++k) {
    if (now_.accepted[k]) loops.push_back(static_cast<Index>(k));
  }
  const auto covariances = estimate_.relative_covariances(loops);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const Index k = loops[i];
    const auto& link = graph_.loops[k];
    const Matrix own = link.covariance * now_.scale.loops;
    const auto prediction =
        predict_without<Pose>(estimate_.residual(link), covariances[i], own / now_.weights[k]);
    const auto gain = loop_gain<Pose>(prediction, own, now_.nu);
    // Alone it would join parts that lie anywhere on the map.
    const double density = std::max(gain.log_density, -objective_.log_volume() - 0.5 * gain.chi2);
    standings_[k] = {.connected = true, .chi2 = gain.chi2};
    standings_[k].evidence = density - objective_.log_alternative(k, near_, now_.scale.loops);
  }
}

// Accepting loops only ever sharpens predictions, so that an old covariance is an upper bound:
// those that are hopeless even so are not solved for again.
template <class Pose>
void Climb<Pose>::weigh_others() {
  Selection hopeful;
  for (std::size_t k = 0; k < now_.accepted.size(); ++k) {
    if (now_.accepted[k]) continue;
    const auto loop = static_cast<Index>(k);
    standings_[k] = weigh(loop);
    if (standings_[k].connected && standings_[k].chi2 < 2.0 * kHopeless) hopeful.push_back(loop);
  }
  refresh(hopeful);
}

template <class Pose>
void Climb<Pose>::refresh(const Selection& loops) {
  const auto covariances = estimate_.relative_covariances(loops);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    covariances_[loops[i]] = covariances[i];
    standings_[loops[i]] = weigh(loops[i]);
  }
}

// One that is not accepted.
template <class Pose>
Standing Climb<Pose>::weigh(Index loop) const {
  const auto& link = graph_.loops[loop];
  Standing standing{.connected = estimate_.connected(link)};
  double density = -objective_.log_volume();
  if (standing.connected) {
    const auto gain = loop_gain<Pose>(predict<Pose>(estimate_.residual(link), covariances_[loop]),
                                      link.covariance * now_.scale.loops, now_.nu);
    standing.chi2 = gain.chi2;
    density = gain.log_density;
  }
  standing.evidence = density - objective_.log_alternative(loop, near_, now_.scale.loops);
  return standing;
}

// Of the loops decided so far: accepted, or so far from what is predicted as hardly one correct
// loop is. One whose prediction is wide says nothing.
template <class Pose>
void Climb<Pose>::add_prior() {
  double kept = 1.0;
  double refuted = 1.0;
  for (std::size_t k = 0; k < standings_.size(); ++k) {
    if (now_.accepted[k]) kept += 1.0;
    if (!now_.accepted[k] && standings_[k].chi2 > refuting_chi2_) refuted += 1.0;
  }
  const double prior = std::log(kept / refuted);
  for (auto& standing : standings_) standing.log_odds = standing.evidence + prior;
}

template <class Pose>
typename Climb<Pose>::Selection Climb<Pose>::misfits() const {
  double worst = 0.0;
  for (std::size_t k = 0; k < standings_.size(); ++k) {
    if (now_.accepted[k]) worst = std::min(worst, standings_[k].log_odds);
  }
  Selection out;
  for (std::size_t k = 0; k < standings_.size(); ++k) {
    if (now_.accepted[k] && worst < 0.0 && standings_[k].log_odds <= 0.5 * worst) {
      out.push_back(static_cast<Index>(k));
    }
  }
  return out;
}

template <class Pose>
typename Climb<Pose>::Selection Climb<Pose>::next_batch() const {
  std::vector<bool> open(standings_.size());
  for (std::size_t k = 0; k < open.size(); ++k) {
    open[k] = !now_.accepted[k] && drops_[k] < kMostDrops;
  }
  auto groups = gaining_groups(objective_.runs(), open, standings_, run_density_, [&](Index k) {
    return objective_.log_alternative(k, near_, now_.scale.loops);
  });
  return most_certain(std::move(groups));
}

template <class Pose>
void Climb<Pose>::forget_bounds() {
  run_density_ = objective_.runs().log_density(now_.scale);
  for (std::size_t k = 0; k < covariances_.size(); ++k) {
    covariances_[k] = graph_.odometry_covariance[k] * now_.scale.odometry;
  }
}

template <class Pose>
double Climb<Pose>::evidence() {
  estimate();
  near_ = objective_.near(estimate_.poses());
  return objective_.evidence(now_, estimate_, near_);
}

// False if nothing is left to learn.
template <class Pose>
bool Climb<Pose>::rescale() {
  bool changed = false;
  for (int k = 0; k < kLearnings; ++k) {
    const CovarianceScale next =
        learn_scales(graph_, estimate_, now_.accepted, now_.weights, now_.scale);
    const bool moved =
        differ(next.odometry, now_.scale.odometry) || differ(next.loops, now_.scale.loops);
    if (moved) {
      now_.scale.odometry = next.odometry;
      now_.scale.loops = next.loops;
      estimate();
    }
    const bool bent = adapt_tail();
    if (!moved && !bent) break;
    changed = true;
  }
  forget_bounds();
  return changed;
}

// To the neighbouring tail of the highest evidence, as far as it rises.
template <class Pose>
bool Climb<Pose>::adapt_tail() {
  auto at = std::ranges::find(kTails, now_.nu) - kTails.begin();
  double best = objective_.evidence(now_, estimate_, near_);
  bool changed = false;
  for (const int step : {-1, 1}) {
    while (at + step >= 0 && at + step < std::ssize(kTails)) {
      const auto before = now_;
      const auto layout = estimate_.layout();
      now_.nu = kTails[static_cast<std::size_t>(at + step)];
      if (now_.nu >= kGaussian) std::ranges::fill(now_.weights, 1.0);
      estimate();
      const double evidence = objective_.evidence(now_, estimate_, near_);
      if (evidence <= best + kBetter) {
        now_ = before;
        estimate_.restore(layout);
        estimate();
        break;
      }
      best = evidence;
      at += step;
      changed = true;
    }
    if (changed) break;
  }
  return changed;
}

template <class Pose>
void Climb<Pose>::tell_progress() const {
  if (!progress_) return;
  const auto kept = static_cast<std::uint64_t>(std::ranges::count(now_.accepted, true));
  if (!progress_({"evidence", kept, now_.accepted.size()})) throw Cancelled();
}

template class Climb<Pose2>;
template class Climb<Pose3>;

}  // namespace isotherm::slam::detail
