#include "prune/consensus/climb/climb.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include "isotherm/base/error.hpp"
#include "prune/consensus/climb/learn.hpp"
#include "prune/consensus/climb/slip_trials.hpp"
#include "prune/consensus/log_odds.hpp"
#include "prune/consensus/objective/scale_prior.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kMostVain = 8;                     // moves in a row that find nothing better
constexpr double kWorthTelling = 0.1 * kBetter;  // of scales that change no verdict

// Whether an accepted loop is taken for less accurate than most.
template <class Pose>
bool any_is_worse(const Explanation<Pose>& found) {
  const ScaleMixture mixture = found.mixture();
  for (std::size_t k = 0; k < found.accepted.size(); ++k) {
    const double factor = mixture.factor(found.weights[k]);
    if (found.accepted[k] && are_of_different_scales(factor, 1.0)) return true;
  }
  return false;
}

}  // namespace

template <class Pose>
Climb<Pose>::Climb(const Objective<Pose>& objective, ConsensusOptions options, RunContext run,
                   Pace pace)
    : objective_(objective),
      options_(std::move(options)),
      run_(std::move(run)),
      pace_(std::move(pace)),
      at_(objective, options_.calibrate, pace_, run_.threads),
      last_held_(objective.stated().reduced.loops.size()) {}

template <class Pose>
Explanation<Pose> Climb<Pose>::from(const CovarianceScale& scale, bool known) {
  const Explanation<Pose> none = none_at(scale);
  if (known && options_.calibrate) {
    take_what_agrees(none);
  } else {
    start(none);
  }
  return climb();
}

// As if its scales were known. Where nothing tells of them odometry may err by any factor, and any
// loop may be true: a run of false ones that agree with each other is the likeliest then.
template <class Pose>
void Climb<Pose>::take_what_agrees(const Explanation<Pose>& none) {
  {
    const auto known = at_.assessment.as_if_scales_were_known();
    start(none);
    shift_and([] { return false; });
  }
  at_.assess();
}

// Learns no scales before it has accepted what they say.
template <class Pose>
Explanation<Pose> Climb<Pose>::from(Standpoint<Pose> standpoint) {
  stand_on(std::move(standpoint));
  at_.learn_no_more_from(at_.now.accepted_count());
  return climb();
}

template <class Pose>
Explanation<Pose> Climb<Pose>::climb() {
  double before = at_.best.evidence;
  do {
    before = at_.best.evidence;
    std::fill(at_.dropped.begin(), at_.dropped.end(), false);
    const Explanation<Pose>* known = grow();
    if (known != nullptr && known->evidence >= at_.best.evidence) {
      return at_.peaks.end_at_known(*known);
    }
  } while (at_.best.evidence > before + kBetter);
  at_.peaks.end_at(at_.best);
  return at_.best;
}

template <class Pose>
Explanation<Pose> Climb<Pose>::resume(Standpoint<Pose> standpoint) {
  stand_on(std::move(standpoint));
  int vain = 0;
  for (int round = 0; round < options_.max_rounds && vain < kMostVain; ++round) {
    tell_progress();
    const double highest = at_.best.evidence;
    if (!shift() && !at_.learn_more_than(0.0) && !at_.find_slips()) break;
    vain = at_.best.evidence > highest + kBetter ? 0 : vain + 1;
  }
  at_.peaks.end_at(at_.best);
  return at_.best;
}

template <class Pose>
void Climb<Pose>::stand_at(const Explanation<Pose>& found) {
  if (!is_at(found) || !at_.assessment.estimate().is_factorised()) {
    stand_on({found, at_.assessment.findings()});
  }
}

template <class Pose>
bool Climb<Pose>::is_at(const Explanation<Pose>& found) const {
  return at_.now.accepted == found.accepted && at_.now.evidence == found.evidence &&
         at_.now.scale == found.scale && at_.now.shapes == found.shapes;
}

template <class Pose>
void Climb<Pose>::begin_at(const Explanation<Pose>& found) {
  if (!is_at(found)) return stand_on({found, at_.assessment.findings()});
  at_.begin();
}

template <class Pose>
bool Climb<Pose>::explains_all(const Explanation<Pose>& found) const {
  return are_few(found.expected_wrong(std::vector<bool>(found.accepted.size(), true)));
}

template <class Pose>
bool Climb<Pose>::is_decided(const Explanation<Pose>& found) const {
  return are_few(found.expected_wrong(found.accepted));
}

template <class Pose>
bool Climb<Pose>::are_few(double wrong) const {
  return wrong <= options_.significance * static_cast<double>(last_held_.size());
}

template <class Pose>
Explanation<Pose> Climb<Pose>::slipping(const Explanation<Pose>& found) {
  doubted_.clear();
  const bool hidden = any_is_worse(found);
  const bool rejected = looks_afar_ && !found.accepts_all();
  if (!hidden && !rejected) return found;
  begin_at(found);
  SlipTrials<Pose> trials(
      at_, {.shift = [this] { return shift(); }, .settle = [this] { settle(at_.now.accepted); }},
      log_odds_of(1.0 - options_.significance));
  const bool unhidden = hidden && trials.as_if_accurate();
  const bool believed = rejected && trials.for_rejected_runs();
  doubted_ = std::move(trials).doubted();
  return unhidden || believed ? climb() : found;
}

template <class Pose>
Explanation<Pose> Climb<Pose>::refined(const Explanation<Pose>& found) {
  begin_at(found);
  if (!to_the_last_ && !at_.try_another_map()) return found;
  while (at_.learn_more_than(0.0, kWorthTelling)) {
  }
  return at_.now;
}

template <class Pose>
Explanation<Pose> Climb<Pose>::all_true(const Explanation<Pose>& found, double least) {
  begin_at(found);
  const auto accept_all = [](auto& now) { now.accepted.assign(now.accepted.size(), true); };
  const TrialTerms terms{.gain = least - found.evidence, .learning = true};
  return at_.try_with(accept_all, terms) ? settle(at_.now.accepted) : found;
}

// Grows to them first, the most certain before the rest, so that poses come near.
template <class Pose>
Explanation<Pose> Climb<Pose>::settled_on(const std::vector<bool>& accepted,
                                          const CovarianceScale& start_scale) {
  start(none_at(start_scale));
  for (std::size_t k = 0; k < accepted.size(); ++k) at_.dropped[k] = !accepted[k];
  shift_and([this] { return at_.learn_more_than(0.0) || explain_the_same_better(); });
  return settle(accepted);
}

// Each loop is weighed first by what odometry says of it, that slips where it was found to.
template <class Pose>
Explanation<Pose> Climb<Pose>::settled_near(const Explanation<Pose>& found,
                                            const CovarianceScale& scale) {
  Explanation<Pose> none = none_at(scale);
  none.shapes.slips = found.shapes.slips;
  start(std::move(none));
  at_.assessment.stand_on(found.layout);
  return settle(found.accepted);
}

template <class Pose>
const Explanation<Pose>& Climb<Pose>::settle(const std::vector<bool>& accepted) {
  at_.now.accepted = accepted;
  at_.assess();
  while (at_.learn_more_than(0.0) || explain_the_same_better()) {
  }
  return at_.now;
}

template <class Pose>
const Explanation<Pose>* Climb<Pose>::nothing(double least) {
  if (!nothing_ && least < nothing_below_) at_.aside([&] { find_nothing(least); });
  return nothing_ && nothing_->evidence >= least ? &*nothing_ : nullptr;
}

template <class Pose>
void Climb<Pose>::find_nothing(double least) {
  at_.now = none_at({});
  std::tie(at_.now.scale.odometry, at_.now.shapes.odometry) =
      scale_and_shape<typename Pose::Tangent>(objective_.most_odometry().cwiseMin(0.0));
  at_.assessment.start_over();
  if (at_.assessment.assess(at_.now, least)) {
    nothing_ = at_.now;
  } else {
    nothing_below_ = least;
  }
}

template <class Pose>
Explanation<Pose> Climb<Pose>::none_at(const CovarianceScale& scale) const {
  const std::size_t loops = objective_.stated().reduced.loops.size();
  Explanation<Pose> none{.accepted = std::vector<bool>(loops), .scale = scale};
  none.shares.loops[0] = static_cast<double>(loops);
  none.weights.resize(loops);
  return none;
}

template <class Pose>
void Climb<Pose>::start(Explanation<Pose> explanation) {
  at_.now = std::move(explanation);
  at_.assessment.start_over();
  at_.assessment.assess(at_.now);
  at_.begin();
}

template <class Pose>
void Climb<Pose>::stand_on(Standpoint<Pose> standpoint) {
  at_.now = std::move(standpoint.explanation);
  at_.assessment.restore(at_.now, std::move(standpoint.found));
  at_.assessment.assess(at_.now);
  at_.begin();
}

// The peak of an earlier climb that this one leads to, if any.
template <class Pose>
const Explanation<Pose>* Climb<Pose>::grow() {
  int vain = 0;          // moves since the best explanation so far
  std::size_t most = 0;  // loops so far: a climb that grows again to as many goes round in a circle
  for (int round = 0; round < options_.max_rounds; ++round) {
    tell_progress();
    const double before = at_.best.evidence;
    const std::size_t had = at_.now.accepted_count();
    const bool learnt =
        had >= kMoreTelling * at_.learnt_from() && at_.learn_more_than(gain_of_dropping(misfits()));
    if (const auto* known = had > 0 ? at_.peaks.beyond(at_.now) : nullptr) return known;
    if (!learnt && !move()) return nullptr;
    const std::size_t has = at_.now.accepted_count();
    const bool grows = 2 * has >= 3 * had && has > most;
    most = std::max(most, has);
    vain = grows || at_.best.evidence > before + kBetter ? 0 : vain + 1;
    if (vain == kMostVain) return nullptr;
  }
  settled_ = false;
  return nullptr;
}

// False where no move is left, or none that is sought.
template <class Pose>
bool Climb<Pose>::move() {
  if (shift() || at_.learn_more_than(0.0)) return true;
  if (!to_the_last_ && at_.is_highest() && is_decided(at_.now)) return false;
  return explain_the_same_better() ||
         at_.once(Trial::undecided, [this] { return accept_undecided(); }) ||
         (at_.is_highest() && at_.once(Trial::doubted, [this] { return drop_doubted_run(); }));
}

// Until neither finds anything.
template <class Pose>
void Climb<Pose>::shift_and(const std::function<bool()>& other) {
  for (int round = 0; round < options_.max_rounds && (shift() || other()); ++round) tell_progress();
}

// The same at about these scales.
template <class Pose>
bool Climb<Pose>::shift() {
  const Selection out = misfits();
  const Group batch = next_batch();
  const double dropping = gain_of_dropping(out);
  if (!batch.loops.empty() && batch.gain > dropping) {
    accept(batch.loops);
  } else if (!out.empty()) {
    if (!at_.learn_more_than(dropping)) drop(out);
  } else {
    return false;
  }
  return true;
}

// A loop that is taken for accurate draws the map to itself, and looks accurate there: each is as
// accurate as the others say.
template <class Pose>
bool Climb<Pose>::weigh_by_others() {
  const ScaleMixture& mixture = at_.assessment.findings().mixture;
  std::vector<LoopWeight> weights = at_.now.weights;
  bool differ = false;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!at_.now.accepted[k]) continue;
    weights[k] = at_.now.standings[k].weight;
    differ = differ || are_of_different_scales(mixture.factor(weights[k]),
                                               mixture.factor(at_.now.weights[k]));
  }
  return differ && at_.try_with([&](auto& now) { now.weights = weights; });
}

// Lessons hold residuals. Where some loops are taken for exact the map bends to them, and odometry
// or the other loops have all the errors: what can be learnt of where all loops are taken for as
// accurate as the worst is to explain them better.
template <class Pose>
bool Climb<Pose>::weigh_afar() {
  const auto [factor, shares] = all_as_worst(at_.now.shares);
  if (!options_.calibrate || !looks_afar_ || !at_.now.tells_of_scales()) return false;
  const Lesson<Pose> wider{
      {at_.now.scale.odometry, at_.now.scale.loops * factor}, at_.now.shapes, shares};
  return std::log(wider.scale.loops) < kMostScale &&
         at_.try_with(scales_of(wider), {.learning = true});
}

// By another map, other weights, slips or scales.
template <class Pose>
bool Climb<Pose>::explain_the_same_better() {
  return at_.once(Trial::map, [this] { return at_.try_another_map(); }) ||
         at_.once(Trial::weights_by_others, [this] { return weigh_by_others(); }) ||
         at_.once(Trial::afar, [this] { return weigh_afar(); }) || at_.find_slips();
}

// All loops that are not false beyond doubt: where a part of the map is off each of them speaks for
// itself alone, and against the map, which together they may put right.
template <class Pose>
bool Climb<Pose>::accept_undecided() {
  Selection loops;
  for (std::size_t k = 0; k < at_.now.standings.size(); ++k) {
    if (!at_.now.accepted[k] && at_.now.standings[k].connected() &&
        at_.now.standings[k].log_odds > -beyond_doubt()) {
      loops.push_back(static_cast<Index>(k));
    }
  }
  const auto take = [&](auto&) { at_.take_as(loops, true); };
  if (loops.empty() || !at_.try_with(take, {.learning = true})) return false;
  note(loops.size(), 0);
  return true;
}

// Loops of a run hold each other, and the map: each by itself looks true beside the others. Only
// where nothing higher was found, since a trial of each run takes time: those that the map could
// not spare when they were last tried come last, since they are likely still needed.
template <class Pose>
bool Climb<Pose>::drop_doubted_run() {
  std::vector<bool> doubted(at_.now.accepted.size());
  for (std::size_t k = 0; k < doubted.size(); ++k) {
    doubted[k] = at_.now.accepted[k] && at_.now.standings[k].log_odds < beyond_doubt();
  }
  auto runs = groups_of(at_.assessment, at_.now, doubted);
  const auto promise = [this](const Group& run) {
    return std::pair(-last_held_[run.loops.front()], gain_of_dropping(run.loops));
  };
  std::ranges::stable_sort(runs, std::greater{}, promise);
  for (const Group& run : runs) {
    const auto drop = [&](auto&) { at_.take_as(run.loops, false); };
    if (at_.try_with(drop, {.learning = true})) {
      note(0, run.loops.size());
      return true;
    }
    ++held_;
    for (const Index k : run.loops) last_held_[k] = held_;
  }
  return false;
}

// Of the accepted loops that lower the evidence the worse half, and all that are at least half as
// bad as the worst: each one dropped changes what is predicted of the rest.
template <class Pose>
typename Climb<Pose>::Selection Climb<Pose>::misfits() const {
  const auto& standings = at_.now.standings;
  std::vector<double> worst;
  for (std::size_t k = 0; k < standings.size(); ++k) {
    if (at_.now.accepted[k] && standings[k].log_odds < 0.0) worst.push_back(standings[k].log_odds);
  }
  if (worst.empty()) return {};
  std::ranges::sort(worst);
  const double most = std::max(0.5 * worst.front(), worst[worst.size() / 2]);
  Selection out;
  for (std::size_t k = 0; k < standings.size(); ++k) {
    if (at_.now.accepted[k] && standings[k].log_odds <= most) out.push_back(static_cast<Index>(k));
  }
  return out;
}

template <class Pose>
double Climb<Pose>::gain_of_dropping(const Selection& loops) const {
  double gain = 0.0;
  for (const Index k : loops) gain -= at_.now.standings[k].log_odds;
  return gain;
}

template <class Pose>
void Climb<Pose>::drop(const Selection& loops) {
  at_.take_as(loops, false);
  at_.assess();
  note(0, loops.size());
}

template <class Pose>
std::vector<Group> Climb<Pose>::gaining_groups() const {
  auto all = groups_of(at_.assessment, at_.now, at_.open());
  std::erase_if(all, [](const Group& group) { return group.gain <= 0.0; });
  return all;
}

template <class Pose>
Group Climb<Pose>::next_batch() const {
  return most_certain(gaining_groups(), at_.now.accepted_count());
}

template <class Pose>
void Climb<Pose>::accept(const Selection& loops) {
  at_.take_as(loops, true);
  at_.assess();
  note(loops.size(), 0);
}

template <class Pose>
void Climb<Pose>::note(std::size_t accepted, std::size_t dropped) {
  moves_.push_back({.accepted = static_cast<std::int64_t>(accepted),
                    .dropped = static_cast<std::int64_t>(dropped),
                    .in_force = static_cast<std::int64_t>(at_.now.accepted_count())});
}

template <class Pose>
void Climb<Pose>::tell_progress() const {
  if (!run_.progress) return;
  if (!run_.progress({"consensus", at_.now.accepted_count(), at_.now.accepted.size()}))
    throw Cancelled();
}

template class Climb<Pose2>;
template class Climb<Pose3>;

}  // namespace isotherm::slam::detail
