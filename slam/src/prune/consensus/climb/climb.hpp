#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/prune/consensus.hpp"
#include "prune/consensus/climb/assessment.hpp"
#include "prune/consensus/climb/groups.hpp"
#include "prune/consensus/climb/learn.hpp"
#include "prune/consensus/climb/standpoint.hpp"
#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {

/// What a trial is to gain, with the map sought from a layout, and by what can be learnt then.
template <class Pose>
struct TrialTerms {
  double gain = kBetter;
  const typename Estimate<Pose>::Layout* from = nullptr;
  bool learning = false;
};

/// Climbs to an explanation of higher evidence, one move after the other: accept the loops and
/// the runs of loops that raise it, the most certain first, since every one accepted sharpens
/// what is predicted of the rest; where some lower it, drop the worst or learn the scales and
/// the tail from what is accepted, whichever gains more.
template <class Pose>
class Climb {
 public:
  using Selection = std::vector<Index>;

  /// `objective` must outlive this object.
  Climb(const Objective<Pose>& objective, ConsensusOptions options, RunContext run, Pace pace = {});

  /// The same on other loops.
  Climb on(const Objective<Pose>& objective) const { return {objective, options_, run_, pace_}; }

  const Objective<Pose>& objective() const noexcept { return objective_; }
  const ConsensusOptions& options() const noexcept { return options_; }

  /// Climbs from nothing accepted, with `start` as the factors on the covariances; the best
  /// explanation on the way.
  Explanation<Pose> from(const CovarianceScale& start);

  /// The same from there.
  Explanation<Pose> from(Standpoint<Pose> standpoint);

  /// Goes on from there: loops are accepted and dropped and scales learnt while that helps, without
  /// looking for other scales. Later climbs know the peak.
  Explanation<Pose> resume(Standpoint<Pose> standpoint);

  /// Whether climbs seek scales far from those that lessons lead to; on a sample of the loops that
  /// takes less time.
  void look_afar(bool looks) { looks_afar_ = looks; }

  /// See Assessment.
  void hold_nearness(bool held) { assessment_.hold_nearness(held); }

  /// Goes back to an explanation that was found.
  void stand_at(const Explanation<Pose>& found);

  /// Of the explanation that the last call ended at.
  const Assessment<Pose>& assessment() const noexcept { return assessment_; }

  /// On from there with edges of odometry that slip otherwise, where that explains loops better
  /// that hide it: around an edge that slips they look less accurate than others, or are rejected;
  /// or one is accepted that alone tells a slip.
  Explanation<Pose> slipping(const Explanation<Pose>& found);

  /// What explains best that loops are true, or false, which odometry would have to slip otherwise
  /// for, but worse than what was found: of the last call of slipping().
  const std::vector<Explanation<Pose>>& doubted() const noexcept { return doubted_; }

  /// What explains best that exactly these loops are true, from `start`.
  Explanation<Pose> settled_on(const std::vector<bool>& accepted, const CovarianceScale& start);

  /// The same of the loops that were found, from the poses that were found with them.
  Explanation<Pose> settled_near(const Explanation<Pose>& found, const CovarianceScale& start);

  /// Nothing accepted, the covariances as stated, odometry's no larger than its steps vary; none
  /// where the evidence of that is below `least`, which takes less time to tell.
  const Explanation<Pose>* nothing(double least = -std::numeric_limits<double>::infinity());

  /// What the climbs did, and whether all ended.
  const std::vector<ConsensusMove>& moves() const noexcept { return moves_; }
  bool settled() const noexcept { return settled_; }

 private:
  enum Trial {
    lesson,
    lesson_of_scales,
    slips,
    level,
    weights_by_others,
    afar,
    undecided,
    doubtful,
    trials
  };

  using Layout = typename Estimate<Pose>::Layout;
  using Change = std::function<void(Explanation<Pose>&)>;

  // What a trial that fails goes back to.
  struct Place {
    Explanation<Pose> now;
    typename Assessment<Pose>::Findings found;
    std::array<bool, trials> failed;
  };

  // Where a climb was, and the number of the peak that it led to; of this one that of the next.
  struct Passed {
    std::vector<bool> accepted;
    CovarianceScale scale;
    double evidence;
    std::size_t peak;
  };

  Explanation<Pose> none_at(const CovarianceScale& scale) const;
  void start(Explanation<Pose> explanation);
  void stand_on(Standpoint<Pose> standpoint);
  void begin();
  Explanation<Pose> climb();
  const Explanation<Pose>* peak_ahead(bool learnt);
  const Explanation<Pose>& lead_to(const Explanation<Pose>& peak);
  bool is_here(const Passed& passed) const;
  const Explanation<Pose>& settle(const std::vector<bool>& accepted);
  bool outdoes(double evidence);
  const Explanation<Pose>* grow();
  bool move();
  bool shift();
  bool assess(double least = -std::numeric_limits<double>::infinity());
  Selection misfits() const;
  double gain_of_dropping(const Selection& loops) const;
  void take_as(const Selection& loops, bool accepted);
  void drop(const Selection& loops);
  std::vector<bool> open() const;
  std::vector<Group> groups(const std::vector<bool>& among) const;
  std::vector<Group> gaining_groups() const;
  Group next_batch() const;
  void accept(const Selection& loops);
  bool try_all_as(const Selection& loops, bool accepted);
  bool learn_more_than(double gain);
  bool find_slips();
  bool take_slips(double least);
  bool try_best_slips(double least);
  bool level_odometry();
  bool slip_as_if_accurate();
  bool slip_for_any(const std::vector<Selection>& all, bool accepted);
  bool slip_for(const Selection& loops, bool accepted);
  bool slip_elsewhere(const Link<Pose>& loop);
  std::vector<Selection> rejected_runs() const;
  std::vector<Selection> strays() const;
  void slip(std::span<const SlipChange> changes);
  bool once(Trial trial, const std::function<bool()>& move);
  bool weigh_anew();
  bool weigh_by_others();
  bool weigh_afar();
  bool accept_undecided();
  bool drop_undecided();
  void draw_anew();
  bool all_or_nothing(const std::function<bool()>& moves);
  bool try_with(const Change& change, const TrialTerms<Pose>& terms = {});
  Place place() const { return {now_, assessment_.findings(), failed_}; }
  void go_back(const Place& place);
  void note(std::size_t accepted, std::size_t dropped);
  void tell_progress() const;

  const Objective<Pose>& objective_;
  ConsensusOptions options_;
  RunContext run_;
  Pace pace_;
  Assessment<Pose> assessment_;
  Explanation<Pose> now_;
  Explanation<Pose> best_;
  std::optional<Explanation<Pose>> nothing_;
  double nothing_below_ = std::numeric_limits<double>::infinity();  // its evidence, where not known
  std::vector<Explanation<Pose>> peaks_;                            // of earlier climbs
  std::vector<Explanation<Pose>> doubted_;
  std::vector<Passed> passed_;
  std::vector<bool> dropped_;          // since the climb last rose; not tried again
  std::size_t learnt_from_ = 0;        // loops, at the last lesson
  std::size_t drawn_from_ = 0;         // loops, when the map was last drawn anew
  std::array<bool, trials> failed_{};  // trials here; not repeated until a change
  bool looks_afar_ = true;
  std::vector<ConsensusMove> moves_;
  bool settled_ = true;
};

extern template class Climb<Pose2>;
extern template class Climb<Pose3>;

}  // namespace isotherm::slam::detail
