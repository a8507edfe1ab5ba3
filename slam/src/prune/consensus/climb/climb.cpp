#include "prune/consensus/climb/climb.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "isotherm/base/error.hpp"
#include "prune/consensus/climb/groups.hpp"
#include "prune/consensus/objective/log_odds.hpp"
#include "prune/consensus/objective/scale_prior.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kMostVain = 8;  // moves in a row that find nothing better

bool is_part(const std::vector<bool>& part, const std::vector<bool>& whole) {
  for (std::size_t k = 0; k < part.size(); ++k) {
    if (part[k] && !whole[k]) return false;
  }
  return true;
}

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

// Takes the scales of a lesson or of another explanation.
template <class Found>
auto scales_of(const Found& found) {
  return [&found](auto& now) {
    now.scale = found.scale;
    now.shapes = found.shapes;
    now.shares = found.shares;
  };
}

}  // namespace

template <class Pose>
Climb<Pose>::Climb(const Objective<Pose>& objective, ConsensusOptions options, RunContext run,
                   Pace pace)
    : objective_(objective),
      options_(std::move(options)),
      run_(std::move(run)),
      pace_(std::move(pace)),
      assessment_(objective, pace_, run_.threads) {}

template <class Pose>
Explanation<Pose> Climb<Pose>::from(const CovarianceScale& scale) {
  start(none_at(scale));
  return climb();
}

// Learns no scales before it has accepted what they say.
template <class Pose>
Explanation<Pose> Climb<Pose>::from(Standpoint<Pose> standpoint) {
  stand_on(std::move(standpoint));
  learnt_from_ = now_.accepted_count();
  return climb();
}

template <class Pose>
Explanation<Pose> Climb<Pose>::climb() {
  double before = best_.evidence;
  do {
    before = best_.evidence;
    std::fill(dropped_.begin(), dropped_.end(), false);
    const Explanation<Pose>* known = grow();
    if (known != nullptr && known->evidence >= best_.evidence) return lead_to(*known);
  } while (best_.evidence > before + kBetter);
  peaks_.push_back(best_);
  return best_;
}

template <class Pose>
const Explanation<Pose>& Climb<Pose>::lead_to(const Explanation<Pose>& peak) {
  for (Passed& passed : passed_) {
    if (passed.peak == peaks_.size()) passed.peak = static_cast<std::size_t>(&peak - peaks_.data());
  }
  return peak;
}

template <class Pose>
Explanation<Pose> Climb<Pose>::resume(Standpoint<Pose> standpoint) {
  stand_on(std::move(standpoint));
  int vain = 0;
  for (int round = 0; round < options_.max_rounds && vain < kMostVain; ++round) {
    tell_progress();
    const double highest = best_.evidence;
    if (!shift() && !learn_more_than(0.0) && !find_slips()) break;
    vain = best_.evidence > highest + kBetter ? 0 : vain + 1;
  }
  peaks_.push_back(best_);
  return best_;
}

template <class Pose>
void Climb<Pose>::stand_at(const Explanation<Pose>& found) {
  const bool there = now_.accepted == found.accepted && now_.evidence == found.evidence &&
                     now_.scale == found.scale && now_.shapes == found.shapes;
  if (there && assessment_.estimate().is_factorised()) return;
  now_ = found;
  assessment_.restore(now_, assessment_.findings());
  assess();
}

template <class Pose>
Explanation<Pose> Climb<Pose>::slipping(const Explanation<Pose>& found) {
  doubted_.clear();
  const bool hidden = any_is_worse(found);
  const bool rejected = looks_afar_ && !found.accepts_all();
  if (!hidden && !rejected) return found;
  stand_on({found, assessment_.findings()});
  const bool unhidden = hidden && slip_as_if_accurate();
  const bool believed = rejected && slip_for_any(rejected_runs(), true);
  const bool disbelieved = rejected && slip_for_any(strays(), false);
  return unhidden || believed || disbelieved ? climb() : found;
}

// Grows to them first, the most certain before the rest, so that poses come near.
template <class Pose>
Explanation<Pose> Climb<Pose>::settled_on(const std::vector<bool>& accepted,
                                          const CovarianceScale& start_scale) {
  start(none_at(start_scale));
  for (std::size_t k = 0; k < accepted.size(); ++k) dropped_[k] = !accepted[k];
  grow();
  return settle(accepted);
}

// Each loop is weighed first by what odometry says of it, that slips where it was found to.
template <class Pose>
Explanation<Pose> Climb<Pose>::settled_near(const Explanation<Pose>& found,
                                            const CovarianceScale& scale) {
  Explanation<Pose> none = none_at(scale);
  none.shapes.slips = found.shapes.slips;
  start(std::move(none));
  assessment_.stand_on(found.layout);
  return settle(found.accepted);
}

template <class Pose>
const Explanation<Pose>& Climb<Pose>::settle(const std::vector<bool>& accepted) {
  now_.accepted = accepted;
  assess();
  const auto by_levelling = [this] { return level_odometry(); };
  while (learn_more_than(0.0) || weigh_anew() || find_slips() || once(Trial::level, by_levelling)) {
  }
  return now_;
}

template <class Pose>
const Explanation<Pose>* Climb<Pose>::nothing(double least) {
  if (!nothing_ && least < nothing_below_) {
    now_ = none_at({});
    std::tie(now_.scale.odometry, now_.shapes.odometry) =
        scale_and_shape<typename Pose::Tangent>(objective_.most_odometry().cwiseMin(0.0));
    assessment_.start_over();
    if (assessment_.assess(now_, least)) {
      nothing_ = now_;
    } else {
      nothing_below_ = least;
    }
  }
  return nothing_ && nothing_->evidence >= least ? &*nothing_ : nullptr;
}

// That of an earlier climb which passed here, which explains the same loops better, or which holds
// all loops of this one and explains them better, by its scales and map too where those were
// `learnt` from them; but not where this climb can learn better ones.
template <class Pose>
const Explanation<Pose>* Climb<Pose>::peak_ahead(bool learnt) {
  for (const Passed& passed : passed_) {
    if (passed.peak != peaks_.size() && is_here(passed)) return &peaks_[passed.peak];
  }
  for (const auto& peak : peaks_) {
    if (now_.accepted == peak.accepted) {
      if (!outdoes(peak.evidence)) return &peak;
    } else if (learnt && is_part(now_.accepted, peak.accepted)) {
      const Place here = place();
      if (!try_with(scales_of(peak), {.gain = -kBetter, .from = &peak.layout})) continue;
      const double there = now_.evidence;
      go_back(here);
      if (!outdoes(there)) return &peak;
    }
  }
  return nullptr;
}

// The same loops at about the same scales, and not better.
template <class Pose>
bool Climb<Pose>::is_here(const Passed& passed) const {
  return now_.accepted == passed.accepted && now_.evidence <= passed.evidence + kBetter &&
         about_the_same(now_.scale, passed.scale);
}

// Whether the scales that can be learnt from here explain the same loops better. Each lesson gains
// less than the one before: it ends where one more like the last would not lead there.
template <class Pose>
bool Climb<Pose>::outdoes(double evidence) {
  double before = -std::numeric_limits<double>::infinity();
  while (now_.evidence <= evidence && 2.0 * now_.evidence - before > evidence) {
    before = now_.evidence;
    if (!learn_more_than(0.0)) break;
  }
  return now_.evidence > evidence;
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
  now_ = std::move(explanation);
  assessment_.start_over();
  begin();
}

template <class Pose>
void Climb<Pose>::stand_on(Standpoint<Pose> standpoint) {
  now_ = std::move(standpoint.explanation);
  assessment_.restore(now_, std::move(standpoint.found));
  begin();
}

template <class Pose>
void Climb<Pose>::begin() {
  dropped_.assign(now_.accepted.size(), false);
  learnt_from_ = drawn_from_ = 0;
  failed_ = {};
  assessment_.assess(now_);
  best_ = now_;
}

// The peak of an earlier climb that this one leads to, if any.
template <class Pose>
const Explanation<Pose>* Climb<Pose>::grow() {
  int vain = 0;  // moves since the best explanation so far
  for (int round = 0; round < options_.max_rounds; ++round) {
    tell_progress();
    const double before = best_.evidence;
    const std::size_t had = now_.accepted_count();
    const bool settled = had == 0 || assessment_.estimate().settled();
    if (!settled && had >= kMoreTelling * drawn_from_) draw_anew();
    const bool learnt =
        had >= kMoreTelling * learnt_from_ && learn_more_than(gain_of_dropping(misfits()));
    if (const auto* known = had > 0 ? peak_ahead(learnt) : nullptr) return known;
    if (!learnt && !move()) return nullptr;
    const bool grows = 2 * now_.accepted_count() >= 3 * had;
    vain = grows || best_.evidence > before + kBetter ? 0 : vain + 1;
    if (vain == kMostVain) return nullptr;
  }
  settled_ = false;
  return nullptr;
}

// False where no move is left.
template <class Pose>
bool Climb<Pose>::move() {
  return shift() || learn_more_than(0.0) || weigh_anew() || find_slips() ||
         once(Trial::undecided, [this] { return accept_undecided(); }) ||
         once(Trial::doubtful, [this] { return drop_undecided(); });
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
    if (!learn_more_than(dropping)) drop(out);
  } else {
    return false;
  }
  return true;
}

// Unless it failed here before.
template <class Pose>
bool Climb<Pose>::once(Trial trial, const std::function<bool()>& move) {
  if (failed_[trial]) return false;
  if (move()) return true;
  failed_[trial] = true;
  return false;
}

// A loop that is taken for accurate draws the map to itself, and looks accurate there: each is as
// accurate as the others say.
template <class Pose>
bool Climb<Pose>::weigh_by_others() {
  const ScaleMixture& mixture = assessment_.findings().mixture;
  std::vector<LoopWeight> weights = now_.weights;
  bool differ = false;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!now_.accepted[k]) continue;
    weights[k] = now_.standings[k].weight;
    differ = differ ||
             are_of_different_scales(mixture.factor(weights[k]), mixture.factor(now_.weights[k]));
  }
  return differ && try_with([&](auto& now) { now.weights = weights; });
}

// Lessons hold residuals. Where some loops are taken for exact the map bends to them, and odometry
// or the other loops have all the errors: what can be learnt of where all loops are taken for as
// accurate as the worst is to explain them better.
template <class Pose>
bool Climb<Pose>::weigh_afar() {
  const auto [factor, shares] = all_as_worst(now_.shares);
  if (!options_.calibrate || !looks_afar_ || !now_.tells_of_scales()) return false;
  const Lesson<Pose> wider{{now_.scale.odometry, now_.scale.loops * factor}, now_.shapes, shares};
  return std::log(wider.scale.loops) < kMostScale && try_with(scales_of(wider), {.learning = true});
}

template <class Pose>
bool Climb<Pose>::weigh_anew() {
  return once(Trial::weights_by_others, [this] { return weigh_by_others(); }) ||
         once(Trial::afar, [this] { return weigh_afar(); });
}

// All loops that are not false beyond doubt, by twice the log odds that a verdict takes: where a
// part of the map is off each of them speaks for itself alone, and against the map, which together
// they may put right.
template <class Pose>
bool Climb<Pose>::accept_undecided() {
  const double least = 2.0 * log_odds_of(options_.significance);
  Selection loops;
  for (std::size_t k = 0; k < now_.standings.size(); ++k) {
    if (!now_.accepted[k] && now_.standings[k].connected() && now_.standings[k].log_odds > least) {
      loops.push_back(static_cast<Index>(k));
    }
  }
  return try_all_as(loops, true);
}

// All runs of which a loop is not true beyond doubt: as long as the others of a run are accepted,
// each fits.
template <class Pose>
bool Climb<Pose>::drop_undecided() {
  const double most = log_odds_of(1.0 - options_.significance);
  Selection out;
  for (const Group& run : groups(now_.accepted)) {
    const auto in_doubt = [&](Index k) { return now_.standings[k].log_odds < most; };
    if (std::ranges::any_of(run.loops, in_doubt)) {
      out.insert(out.end(), run.loops.begin(), run.loops.end());
    }
  }
  return out.size() < now_.accepted_count() && try_all_as(out, false);
}

// Steps that do not settle may be on the way to another minimum than the least.
template <class Pose>
void Climb<Pose>::draw_anew() {
  drawn_from_ = now_.accepted_count();
  try {
    const Layout relaxed = assessment_.relaxed(now_);
    try_with([](auto&) {}, {.from = &relaxed});
  } catch (const NumericalError&) {  // nothing to start from
  }
}

// Whether the evidence reaches `least`.
template <class Pose>
bool Climb<Pose>::assess(double least) {
  if (!assessment_.assess(now_, least)) return false;
  failed_ = {};
  if (now_.evidence > best_.evidence) best_ = now_;
  passed_.push_back({now_.accepted, now_.scale, now_.evidence, peaks_.size()});
  return true;
}

// Of the accepted loops that lower the evidence the worse half, and all that are at least half as
// bad as the worst: each one dropped changes what is predicted of the rest.
template <class Pose>
typename Climb<Pose>::Selection Climb<Pose>::misfits() const {
  const auto& standings = now_.standings;
  std::vector<double> worst;
  for (std::size_t k = 0; k < standings.size(); ++k) {
    if (now_.accepted[k] && standings[k].log_odds < 0.0) worst.push_back(standings[k].log_odds);
  }
  if (worst.empty()) return {};
  std::ranges::sort(worst);
  const double most = std::max(0.5 * worst.front(), worst[worst.size() / 2]);
  Selection out;
  for (std::size_t k = 0; k < standings.size(); ++k) {
    if (now_.accepted[k] && standings[k].log_odds <= most) out.push_back(static_cast<Index>(k));
  }
  return out;
}

template <class Pose>
double Climb<Pose>::gain_of_dropping(const Selection& loops) const {
  double gain = 0.0;
  for (const Index k : loops) gain -= now_.standings[k].log_odds;
  return gain;
}

template <class Pose>
void Climb<Pose>::take_as(const Selection& loops, bool accepted) {
  for (const Index k : loops) {
    now_.accepted[k] = accepted;
    dropped_[k] = !accepted;
  }
}

template <class Pose>
void Climb<Pose>::drop(const Selection& loops) {
  take_as(loops, false);
  assess();
  note(0, loops.size());
}

template <class Pose>
std::vector<bool> Climb<Pose>::open() const {
  std::vector<bool> open(dropped_.size());
  for (std::size_t k = 0; k < open.size(); ++k) {
    open[k] = !now_.accepted[k] && !dropped_[k];
  }
  return open;
}

template <class Pose>
std::vector<Group> Climb<Pose>::groups(const std::vector<bool>& among) const {
  return groups_of(assessment_, now_, among);
}

template <class Pose>
std::vector<Group> Climb<Pose>::gaining_groups() const {
  auto all = groups(open());
  std::erase_if(all, [](const Group& group) { return group.gain <= 0.0; });
  return all;
}

template <class Pose>
Group Climb<Pose>::next_batch() const {
  return most_certain(gaining_groups(), now_.accepted_count());
}

template <class Pose>
void Climb<Pose>::accept(const Selection& loops) {
  take_as(loops, true);
  assess();
  note(loops.size(), 0);
}

// Whether it gains that all of these are `accepted`, or none, or else nothing changes.
template <class Pose>
bool Climb<Pose>::try_all_as(const Selection& loops, bool accepted) {
  const auto change = [&](auto& now) {
    for (const Index k : loops) now.accepted[k] = accepted;
  };
  if (loops.empty() || !try_with(change, {.learning = accepted})) return false;
  if (!accepted) {
    for (const Index k : loops) dropped_[k] = true;
  }
  note(accepted ? loops.size() : 0, accepted ? 0 : loops.size());
  return true;
}

// Whether there was anything to learn that gains more than this.
template <class Pose>
bool Climb<Pose>::learn_more_than(double gain) {
  if (!options_.calibrate) return false;
  learnt_from_ = std::max<std::size_t>(now_.accepted_count(), 1);
  const double least = std::max(gain, kBetter);
  for (const Trial trial : {Trial::lesson, Trial::lesson_of_scales}) {
    if (failed_[trial]) continue;
    const Lesson<Pose> found = learn(assessment_, now_, trial == Trial::lesson_of_scales);
    if (found.gain <= least) continue;
    if (try_with(scales_of(found))) return true;
    failed_[trial] = true;
    if (found.shapes.is_about(now_.shapes)) failed_[Trial::lesson_of_scales] = true;
  }
  return false;
}

// All edges that gain at least half of what the one does that gains most by erring more than
// others, or no more, since each explains a part of what others would; or else that one.
template <class Pose>
bool Climb<Pose>::try_best_slips(double least) {
  auto changes = assessment_.slip_changes(now_);
  std::erase_if(changes, [least](const SlipChange& change) { return change.gain < least; });
  std::ranges::sort(changes, std::greater{}, &SlipChange::gain);
  std::size_t count = 0;
  while (count < changes.size() && changes[count].gain >= 0.5 * changes.front().gain) ++count;
  const auto try_first = [&](std::size_t some) {
    return try_with([&](auto&) { slip(std::span(changes).first(some)); });
  };
  return count > 0 && (try_first(count) || (count > 1 && try_first(1)));
}

// Until none gains, before loops are accepted that a slip too many leaves room for.
template <class Pose>
bool Climb<Pose>::find_slips() {
  if (!options_.calibrate || failed_[Trial::slips]) return false;
  const bool found = take_slips(0.0);
  failed_[Trial::slips] = !found;
  return found;
}

// Whether there was any that gains as much.
template <class Pose>
bool Climb<Pose>::take_slips(double least) {
  bool any = false;
  while (try_best_slips(least)) any = true;
  return any;
}

// Coordinates that an edge slips in seem to err more than others, until that is known.
template <class Pose>
bool Climb<Pose>::level_odometry() {
  if (now_.shapes.slips.empty() || !options_.calibrate) return false;
  return try_with([](auto& now) { now.shapes.odometry.setOnes(); }, {.learning = true});
}

// Slips that are beyond doubt were all loops as accurate as most, and odometry in all coordinates.
template <class Pose>
bool Climb<Pose>::slip_as_if_accurate() {
  const double least = now_.evidence + kBetter;
  return all_or_nothing([&] {
    const ScaleShares shares = std::exchange(now_.shares, all_as_most(now_.shares));
    now_.weights.assign(now_.weights.size(), {});
    now_.shapes.odometry.setOnes();
    assess();
    const bool found = take_slips(log_odds_of(1.0 - options_.significance));
    now_.shares = shares;
    return found && settle(now_.accepted).evidence > least;
  });
}

// Whether it gains of any of these that they are all `accepted`, or none, until eight in a row do
// not.
template <class Pose>
bool Climb<Pose>::slip_for_any(const std::vector<Selection>& all, bool accepted) {
  bool any = false;
  int vain = 0;
  for (const Selection& loops : all) {
    const Index first = loops.front();
    if (now_.accepted[first] == accepted || !now_.standings[first].connected()) continue;
    const bool gains = slip_for(loops, accepted);
    any = any || gains;
    vain = gains ? 0 : vain + 1;
    if (vain == kMostVain) break;
  }
  return any;
}

// Whether it gains that these are true, or false, and odometry slips otherwise. Else it is what
// explains that best, and how much worse that is says how likely it is.
template <class Pose>
bool Climb<Pose>::slip_for(const Selection& loops, bool accepted) {
  const double least = now_.evidence + kBetter;
  return all_or_nothing([&] {
    std::fill(dropped_.begin(), dropped_.end(), false);
    take_as(loops, accepted);
    assess();
    const auto& first = assessment_.graph().loops[loops.front()];
    if (accepted && !try_best_slips(0.0) && !slip_elsewhere(first)) return false;
    Explanation<Pose> best = now_;
    while (now_.evidence <= least && (try_best_slips(0.0) || shift())) {
      const bool still = now_.accepted[loops.front()] == accepted;
      if (still && now_.evidence > best.evidence) best = now_;
    }
    if (now_.evidence > least) return true;
    doubted_.push_back(std::move(best));
    return false;
  });
}

// Whether another edge explains better what is next to a loop than the one that slips nearest to
// one of its ends does.
template <class Pose>
bool Climb<Pose>::slip_elsewhere(const Link<Pose>& loop) {
  const double least = now_.evidence + kBetter;
  for (const Index end : {loop.a, loop.b}) {
    const auto edge = nearest_slip(now_.shapes.slips, assessment_.graph().vertex[end]);
    const bool better = edge && all_or_nothing([&] {
                          slip(std::array{SlipChange{.vertex = *edge, .slip = 0}});
                          assess();
                          return try_best_slips(0.0) && now_.evidence > least;
                        });
    if (better) return true;
  }
  return false;
}

// The likeliest first: they may be refuted each alone, and tell a slip together.
template <class Pose>
std::vector<typename Climb<Pose>::Selection> Climb<Pose>::rejected_runs() const {
  auto runs = groups(open());
  std::ranges::stable_sort(runs, std::greater{}, &Group::gain);
  std::vector<Selection> loops;
  for (Group& run : runs) loops.push_back(std::move(run.loops));
  return loops;
}

// Accepted loops next to which in their run all are rejected. One that tells a slip alone may be
// false: with it the map agrees with that loop, and with no other of the run.
template <class Pose>
std::vector<typename Climb<Pose>::Selection> Climb<Pose>::strays() const {
  std::vector<int> agree(now_.accepted.size(), 0);
  std::vector<int> differ = agree;
  for (std::size_t k = 0; k < agree.size(); ++k) {
    const Index before = objective_.runs().before(static_cast<Index>(k));
    if (before == Runs<Pose>::kNone) continue;
    auto& count = now_.accepted[k] == now_.accepted[before] ? agree : differ;
    ++count[k];
    ++count[before];
  }
  std::vector<Selection> strays;
  for (std::size_t k = 0; k < agree.size(); ++k) {
    if (now_.accepted[k] && differ[k] > 0 && agree[k] == 0) {
      strays.push_back({static_cast<Index>(k)});
    }
  }
  return strays;
}

template <class Pose>
void Climb<Pose>::slip(std::span<const SlipChange> changes) {
  Slips& changed = now_.shapes.slips;
  changed.resize(objective_.odometry_edges());
  for (const SlipChange& change : changes) {
    changed[static_cast<std::size_t>(change.vertex)] = change.slip;
  }
  if (!any_slips(changed)) changed.clear();
}

// Whether the moves succeed, or else nothing changes. Scales at which the normal equations break
// down explain nothing.
template <class Pose>
bool Climb<Pose>::all_or_nothing(const std::function<bool()>& moves) {
  const Place before = place();
  bool better = false;
  try {
    better = moves();
  } catch (const NumericalError&) {
    better = false;
  }
  if (!better) go_back(before);
  return better;
}

// Whether that gains as much, or else nothing changes.
template <class Pose>
bool Climb<Pose>::try_with(const Change& change, const TrialTerms<Pose>& terms) {
  const double least = now_.evidence + terms.gain;
  return all_or_nothing([&] {
    change(now_);
    if (terms.from) assessment_.stand_on(*terms.from);
    if (terms.learning) assessment_.forget_nearness();
    return terms.learning ? assess() && outdoes(least) : assess(least);
  });
}

template <class Pose>
void Climb<Pose>::go_back(const Place& place) {
  now_ = place.now;
  assessment_.restore(now_, place.found);
  failed_ = place.failed;
}

template <class Pose>
void Climb<Pose>::note(std::size_t accepted, std::size_t dropped) {
  moves_.push_back({.accepted = static_cast<std::int64_t>(accepted),
                    .dropped = static_cast<std::int64_t>(dropped),
                    .in_force = static_cast<std::int64_t>(now_.accepted_count())});
}

template <class Pose>
void Climb<Pose>::tell_progress() const {
  if (!run_.progress) return;
  if (!run_.progress({"consensus", now_.accepted_count(), now_.accepted.size()})) throw Cancelled();
}

template class Climb<Pose2>;
template class Climb<Pose3>;

}  // namespace isotherm::slam::detail
