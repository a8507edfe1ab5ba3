#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/prune/consensus.hpp"
#include "prune/consensus/climb/groups.hpp"
#include "prune/consensus/climb/position.hpp"
#include "prune/consensus/climb/standpoint.hpp"
#include "prune/consensus/log_odds.hpp"

namespace isotherm::slam::detail {

/// Climbs to an explanation of higher evidence, one move after the other: accept the loops and
/// the runs of loops that raise it, the most certain first, since every one accepted sharpens
/// what is predicted of the rest; where some lower it, drop the worst or learn the scales and
/// the tail from what is accepted, whichever gains more.
template <class Pose>
class Climb {
 public:
  using Selection = typename Position<Pose>::Selection;

  /// `objective` must outlive this object.
  Climb(const Objective<Pose>& objective, ConsensusOptions options, RunContext run, Pace pace = {});

  /// The same on other loops.
  Climb on(const Objective<Pose>& objective) const { return {objective, options_, run_, pace_}; }

  const Objective<Pose>& objective() const noexcept { return objective_; }
  const ConsensusOptions& options() const noexcept { return options_; }

  /// Climbs from nothing accepted, at scales that are taken for `known` until no more loop agrees
  /// with them; the best explanation on the way.
  Explanation<Pose> from(const CovarianceScale& scale, bool known = false);

  /// From there.
  Explanation<Pose> from(Standpoint<Pose> standpoint);

  /// Goes on from there: loops are accepted and dropped and scales learnt while that helps, without
  /// looking for other scales. Later climbs know the peak.
  Explanation<Pose> resume(Standpoint<Pose> standpoint);

  /// Whether climbs seek scales far from those that lessons lead to; on a sample of the loops that
  /// takes less time.
  void look_afar(bool looks) { looks_afar_ = looks; }

  /// Whether climbs go on from where as few verdicts are expected to be wrong as may be, to what
  /// explains the same better.
  void go_to_the_last(bool goes) { to_the_last_ = goes; }

  /// See Assessment.
  void hold_nearness(bool held) { at_.assessment.hold_nearness(held); }

  /// Whether as good as all loops are true in what was found: the share of verdicts that would be
  /// wrong if all were kept is expected to be no more than was asked for.
  bool explains_all(const Explanation<Pose>& found) const;

  /// Whether no more of its verdicts are expected to be wrong than may be.
  bool is_decided(const Explanation<Pose>& found) const;

  /// Goes back to an explanation that was found.
  void stand_at(const Explanation<Pose>& found);

  /// Of the explanation that the last call ended at.
  const Assessment<Pose>& assessment() const noexcept { return at_.assessment; }

  /// On from there with edges of odometry that slip otherwise, where that explains loops better
  /// that hide it: around an edge that slips they look less accurate than others, or are rejected.
  Explanation<Pose> slipping(const Explanation<Pose>& found);

  /// What explains best that loops are true which odometry would have to slip otherwise
  /// for, but worse than what was found: of the last call of slipping().
  const std::vector<Explanation<Pose>>& doubted() const noexcept { return doubted_; }

  /// The same loops on another map, where climbs did not go to the last, at scales that are learnt
  /// to a tenth of what a move is worth.
  Explanation<Pose> refined(const Explanation<Pose>& found);

  /// What explains best that all loops are true, from what was found; that where it cannot come
  /// near `least`.
  Explanation<Pose> all_true(const Explanation<Pose>& found, double least);

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
  using Trial = typename Position<Pose>::Trial;

  // Twice the log odds that a verdict takes.
  double beyond_doubt() const { return 2.0 * log_odds_of(1.0 - options_.significance); }
  // Whether so few loops are expected not to be what they are taken for.
  bool are_few(double wrong) const;
  bool is_at(const Explanation<Pose>& found) const;
  void begin_at(const Explanation<Pose>& found);
  void find_nothing(double least);
  Explanation<Pose> none_at(const CovarianceScale& scale) const;
  void start(Explanation<Pose> explanation);
  void stand_on(Standpoint<Pose> standpoint);
  Explanation<Pose> climb();
  void take_what_agrees(const Explanation<Pose>& none);
  const Explanation<Pose>& settle(const std::vector<bool>& accepted);
  const Explanation<Pose>* grow();
  bool move();
  bool shift();
  void shift_and(const std::function<bool()>& other);
  Selection misfits() const;
  double gain_of_dropping(const Selection& loops) const;
  void drop(const Selection& loops);
  std::vector<Group> gaining_groups() const;
  Group next_batch() const;
  void accept(const Selection& loops);
  bool explain_the_same_better();
  bool weigh_by_others();
  bool weigh_afar();
  bool accept_undecided();
  bool drop_doubted_run();
  void note(std::size_t accepted, std::size_t dropped);
  void tell_progress() const;

  const Objective<Pose>& objective_;
  ConsensusOptions options_;
  RunContext run_;
  Pace pace_;
  Position<Pose> at_;
  std::optional<Explanation<Pose>> nothing_;
  double nothing_below_ = std::numeric_limits<double>::infinity();  // its evidence, where not known
  std::vector<Explanation<Pose>> doubted_;
  bool looks_afar_ = true;
  bool to_the_last_ = true;
  int held_ = 0;                // runs that were tried, and could not be spared
  std::vector<int> last_held_;  // by loop, the last of those that it was of
  std::vector<ConsensusMove> moves_;
  bool settled_ = true;
};

extern template class Climb<Pose2>;
extern template class Climb<Pose3>;

}  // namespace isotherm::slam::detail
