#pragma once

#include <array>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "prune/consensus/climb/assessment.hpp"
#include "prune/consensus/climb/peaks.hpp"
#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {

/// What a trial is to gain, and whether by what can be learnt then.
struct TrialTerms {
  double gain = kBetter;
  bool learning = false;
};

/// Takes the scales of a lesson or of another explanation.
template <class Found>
auto scales_of(const Found& found) {
  return [&found](auto& now) {
    now.scale = found.scale;
    now.shapes = found.shapes;
    now.shares = found.shares;
  };
}

/// Where a climb stands, and what is tried from there: where it fails all is as it was. Scales are
/// learnt, and slips found, as far as that helps.
template <class Pose>
class Position {
 public:
  using Selection = std::vector<Index>;
  using Change = std::function<void(Explanation<Pose>&)>;

  /// Trials that are not repeated where they failed until something changes.
  enum Trial {
    lesson,
    lesson_of_scales,
    slips,
    map,
    weights_by_others,
    afar,
    undecided,
    doubted,
    trials
  };

  /// `objective` must outlive this object.
  Position(const Objective<Pose>& objective, bool calibrate, Pace pace, int threads);

  /// From `now`, which has been assessed.
  void begin();

  /// Whether the evidence reaches `least`.
  bool assess(double least = -std::numeric_limits<double>::infinity());

  /// Unless it failed here before.
  bool once(Trial trial, const std::function<bool()>& move);

  /// Goes back to where it stood then.
  void aside(const std::function<void()>& moves);

  /// Whether the moves succeed, or else nothing changes. Scales at which the normal equations break
  /// down explain nothing.
  bool all_or_nothing(const std::function<bool()>& moves);

  /// Whether that gains as much, or else nothing changes.
  bool try_with(const Change& change, TrialTerms terms = {});

  /// The same on a map that does not depend on the present one: poses end at the nearest minimum to
  /// where odometry and the first accepted loops led.
  bool try_another_map();

  /// Whether nothing better was found on the way, and nothing higher by an earlier climb: a trial
  /// that failed may have passed by what is a little higher.
  bool is_highest() const {
    return now.evidence + kBetter > best.evidence && peaks.none_above(now.evidence);
  }

  void take_as(const Selection& loops, bool accepted);

  /// Loops that are neither accepted nor dropped.
  std::vector<bool> open() const;

  /// Whether there was anything to learn that gains more than this, and what is `worth` a move.
  bool learn_more_than(double gain, double worth = kBetter);

  /// How many loops were accepted at the last lesson.
  std::size_t learnt_from() const noexcept { return learnt_from_; }
  void learn_no_more_from(std::size_t loops) { learnt_from_ = loops; }

  /// Until none gains, before loops are accepted that a slip too many leaves room for.
  bool find_slips();

  /// Whether there was any that gains as much.
  bool take_slips(double least);

  /// All edges that gain at least half of what the one does that gains most by erring more than
  /// others, or no more. Where each explains a part of what others would that is too many: the half
  /// of them that gains most is tried, and so on.
  bool try_best_slips(double least);

  Explanation<Pose> now;
  Explanation<Pose> best;  ///< on the way
  Assessment<Pose> assessment;
  Peaks<Pose> peaks;          ///< of all climbs so far
  std::vector<bool> dropped;  ///< since the climb last rose; not tried again

 private:
  // Trials that failed here, and what the lessons among them promised at most.
  struct Failures {
    std::array<bool, trials> of{};
    double promised = 0.0;
  };

  // What a trial that fails goes back to.
  struct Place {
    Explanation<Pose> now;
    typename Assessment<Pose>::Findings found;
    Failures failures;
    std::vector<bool> dropped;
  };

  // Whether it was assessed to the end.
  bool note(bool assessed);
  // Whether the scales that can be learnt from here by more than that explain the same loops
  // better.
  bool outdoes(double evidence, double known);
  Place here() const { return {now, assessment.findings(), failures_, dropped}; }
  void go_back(const Place& place);
  void slip(std::span<const SlipChange> changes);

  bool calibrate_;
  std::size_t learnt_from_ = 0;
  Failures failures_;
};

extern template class Position<Pose2>;
extern template class Position<Pose3>;

}  // namespace isotherm::slam::detail
