#include "prune/evidence/climb/climb.hpp"

#include <algorithm>
#include <utility>

#include "isotherm/base/error.hpp"
#include "prune/evidence/climb/groups.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kBetter = 0.1;  // nats by which an explanation must be better to go on

}  // namespace

template <class Pose>
Climb<Pose>::Climb(const Objective<Pose>& objective, const EvidenceOptions& options,
                   const ProgressCallback& progress)
    : objective_(objective), options_(options), progress_(progress), assessment_(objective) {}

template <class Pose>
Explanation<Pose> Climb<Pose>::from(const CovarianceScale& scale) {
  start(scale);
  for (;;) {
    const double before = best_.evidence;
    std::fill(dropped_.begin(), dropped_.end(), false);
    grow();
    if (best_.evidence <= before + kBetter) return std::move(best_);
  }
}

template <class Pose>
void Climb<Pose>::start(const CovarianceScale& scale) {
  const std::size_t loops = objective_.graph().loops.size();
  now_ = {.accepted = std::vector<bool>(loops, false), .scale = scale};
  now_.shares.loops[0] = static_cast<double>(loops);
  now_.weights.assign(loops, 1.0);
  dropped_.assign(loops, false);
  assessment_.start_over();
  predict_runs();
  assessment_.assess(now_);
  best_ = now_;
}

template <class Pose>
std::vector<Standing> Climb<Pose>::standings(const Explanation<Pose>& explanation) {
  now_ = explanation;
  assessment_.restore(now_);
  for (int k = 0; k < 2; ++k) assessment_.assess(now_);  // weights by the covariances there
  return assessment_.standings();
}

template <class Pose>
void Climb<Pose>::grow() {
  for (int round = 0; round < options_.max_rounds; ++round) {
    tell_progress();
    if (!move()) return;
  }
  settled_ = false;
}

// False where no move is left.
template <class Pose>
bool Climb<Pose>::move() {
  const Selection out = misfits();
  if (out.empty()) {
    const Selection batch = next_batch();
    if (batch.empty()) return learn_more_than(0.0);
    accept(batch);
  } else if (!learn_more_than(gain_of_dropping(out))) {
    drop(out);
  }
  return true;
}

template <class Pose>
void Climb<Pose>::assess() {
  assessment_.assess(now_);
  if (now_.evidence > best_.evidence) best_ = now_;
}

template <class Pose>
typename Climb<Pose>::Selection Climb<Pose>::misfits() const {
  const auto& standings = assessment_.standings();
  double worst = 0.0;
  for (std::size_t k = 0; k < standings.size(); ++k) {
    if (now_.accepted[k]) worst = std::min(worst, standings[k].log_odds);
  }
  Selection out;
  for (std::size_t k = 0; k < standings.size(); ++k) {
    if (now_.accepted[k] && worst < 0.0 && standings[k].log_odds <= 0.5 * worst) {
      out.push_back(static_cast<Index>(k));
    }
  }
  return out;
}

template <class Pose>
double Climb<Pose>::gain_of_dropping(const Selection& loops) const {
  double gain = 0.0;
  for (const Index k : loops) gain -= assessment_.standings()[k].log_odds;
  return gain;
}

template <class Pose>
void Climb<Pose>::drop(const Selection& loops) {
  for (const Index k : loops) {
    now_.accepted[k] = false;
    dropped_[k] = true;
  }
  assess();
  note(0, loops.size());
}

template <class Pose>
typename Climb<Pose>::Selection Climb<Pose>::next_batch() const {
  std::vector<bool> open(dropped_.size());
  for (std::size_t k = 0; k < open.size(); ++k) {
    open[k] = !now_.accepted[k] && !dropped_[k];
  }
  auto groups = gaining_groups(objective_.runs(), open, assessment_.standings(), run_density_,
                               [&](Index k) { return assessment_.log_alternative(k); });
  return most_certain(std::move(groups));
}

template <class Pose>
void Climb<Pose>::accept(const Selection& loops) {
  for (const Index k : loops) now_.accepted[k] = true;
  assess();
  note(loops.size(), 0);
}

// Whether there was anything to learn that gains more than this.
template <class Pose>
bool Climb<Pose>::learn_more_than(double gain) {
  if (!options_.calibrate) return false;
  const Lesson lesson = learn(objective_, assessment_, now_);
  return lesson.gain > std::max(gain, kBetter) && try_lesson(lesson);
}

// Whether it is better.
template <class Pose>
bool Climb<Pose>::try_lesson(const Lesson& lesson) {
  const Explanation<Pose> before = now_;
  now_.scale = lesson.scale;
  now_.shares = lesson.shares;
  assess();
  const bool better = now_.evidence > before.evidence + kBetter;
  if (!better) {
    now_ = before;
    assessment_.restore(now_);
    assessment_.assess(now_);
  }
  predict_runs();
  return better;
}

template <class Pose>
void Climb<Pose>::predict_runs() {
  run_density_ = objective_.runs().log_density(now_.scale);
}

template <class Pose>
void Climb<Pose>::note(std::size_t accepted, std::size_t dropped) {
  moves_.push_back({.accepted = static_cast<std::int64_t>(accepted),
                    .dropped = static_cast<std::int64_t>(dropped),
                    .in_force = std::ranges::count(now_.accepted, true)});
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
