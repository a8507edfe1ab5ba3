#include "prune/consensus/climb/position.hpp"

#include <algorithm>
#include <utility>

#include "isotherm/base/error.hpp"
#include "prune/consensus/climb/learn.hpp"

namespace isotherm::slam::detail {

template <class Pose>
Position<Pose>::Position(const Objective<Pose>& objective, bool calibrate, Pace pace, int threads)
    : assessment(objective, std::move(pace), threads), calibrate_(calibrate) {}

template <class Pose>
void Position<Pose>::begin() {
  dropped.assign(now.accepted.size(), false);
  learnt_from_ = 0;
  failures_ = {};
  best = now;
}

template <class Pose>
bool Position<Pose>::assess(double least) {
  return note(assessment.assess(now, least));
}

template <class Pose>
bool Position<Pose>::note(bool assessed) {
  if (!assessed) return false;
  failures_ = {};
  if (now.evidence > best.evidence) best = now;
  peaks.pass(now);
  return true;
}

template <class Pose>
bool Position<Pose>::once(Trial trial, const std::function<bool()>& move) {
  if (failures_.of[trial]) return false;
  if (move()) return true;
  failures_.of[trial] = true;
  return false;
}

template <class Pose>
void Position<Pose>::take_as(const Selection& loops, bool accepted) {
  for (const Index k : loops) {
    now.accepted[k] = accepted;
    dropped[k] = !accepted;
  }
}

template <class Pose>
std::vector<bool> Position<Pose>::open() const {
  std::vector<bool> open(dropped.size());
  for (std::size_t k = 0; k < open.size(); ++k) {
    open[k] = !now.accepted[k] && !dropped[k];
  }
  return open;
}

template <class Pose>
void Position<Pose>::aside(const std::function<void()>& moves) {
  const Place before = here();
  moves();
  go_back(before);
}

template <class Pose>
bool Position<Pose>::all_or_nothing(const std::function<bool()>& moves) {
  const Place before = here();
  bool better = false;
  try {
    better = moves();
  } catch (const NumericalError&) {
    better = false;
  }
  if (!better) go_back(before);
  return better;
}

template <class Pose>
bool Position<Pose>::try_with(const Change& change, TrialTerms terms) {
  const double least = now.evidence + terms.gain;
  const double known = failures_.promised + kBetter;
  return all_or_nothing([&] {
    change(now);
    if (terms.learning) assessment.forget_nearness();
    return terms.learning ? assess() && outdoes(least, known) : assess(least);
  });
}

template <class Pose>
void Position<Pose>::go_back(const Place& place) {
  now = place.now;
  assessment.restore(now, place.found);
  failures_ = place.failures;
  dropped = place.dropped;
}

template <class Pose>
bool Position<Pose>::try_another_map() {
  const double least = now.evidence + kBetter;
  return all_or_nothing([&] { return note(assessment.assess_on_another_map(now, least)); });
}

template <class Pose>
bool Position<Pose>::learn_more_than(double gain, double worth) {
  if (!calibrate_ || assessment.scales_are_known()) return false;
  learnt_from_ = std::max<std::size_t>(now.accepted_count(), 1);
  const double least = std::max(gain, worth);
  for (const Trial trial : {Trial::lesson, Trial::lesson_of_scales}) {
    if (failures_.of[trial]) continue;
    const Lesson<Pose> found = learn(assessment, now, trial == Trial::lesson_of_scales);
    if (found.gain <= least) continue;
    if (try_with(scales_of(found), {.gain = worth})) return true;
    failures_.of[trial] = true;
    failures_.promised = std::max(failures_.promised, found.gain);
    if (found.shapes.is_about(now.shapes)) failures_.of[Trial::lesson_of_scales] = true;
  }
  return false;
}

// Each lesson gains less than the one before: it ends where one more like the last would not lead
// there. One that promises no more than what failed where the trial began would fail as well.
template <class Pose>
bool Position<Pose>::outdoes(double evidence, double known) {
  double before = -std::numeric_limits<double>::infinity();
  while (now.evidence <= evidence && 2.0 * now.evidence - before > evidence) {
    before = now.evidence;
    if (!learn_more_than(known)) break;
  }
  return now.evidence > evidence;
}

template <class Pose>
bool Position<Pose>::find_slips() {
  return calibrate_ && once(Trial::slips, [this] { return take_slips(0.0); });
}

template <class Pose>
bool Position<Pose>::take_slips(double least) {
  bool any = false;
  while (try_best_slips(least)) any = true;
  return any;
}

template <class Pose>
bool Position<Pose>::try_best_slips(double least) {
  auto changes = assessment.slip_changes(now);
  std::erase_if(changes, [least](const SlipChange& change) { return change.gain < least; });
  std::ranges::sort(changes, std::greater{}, &SlipChange::gain);
  std::size_t some = 0;
  while (some < changes.size() && changes[some].gain >= 0.5 * changes.front().gain) ++some;
  for (; some > 0; some /= 2) {
    if (try_with([&](auto&) { slip(std::span(changes).first(some)); })) return true;
  }
  return false;
}

template <class Pose>
void Position<Pose>::slip(std::span<const SlipChange> changes) {
  Slips& changed = now.shapes.slips;
  changed.resize(assessment.objective().odometry_edges());
  for (const SlipChange& change : changes) {
    changed[static_cast<std::size_t>(change.vertex)] = change.slip;
  }
  if (!any_slips(changed)) changed.clear();
}

template class Position<Pose2>;
template class Position<Pose3>;

}  // namespace isotherm::slam::detail
