#pragma once

#include <string>
#include <utility>
#include <vector>

#include "calibration.hpp"
#include "estimate.hpp"
#include "isotherm/slam/consensus.hpp"
#include "map_volume.hpp"
#include "mutual_support.hpp"
#include "prior_by_span.hpp"
#include "reduced_graph.hpp"

namespace isotherm::slam::detail {

/// The state of forward consensus between two rounds.
template <class Pose>
class Search {
 public:
  using Matrix = typename Pose::Matrix;
  using Tangent = typename Pose::Tangent;

  using Selection = std::vector<Index>;

  /// Both must outlive this object.
  Search(const ReducedGraph<Pose>& graph, const ConsensusOptions& options);

  /// Runs to the end and fills in everything in `result` but the verdicts' edges.
  void run(ConsensusResult& result);

 private:
  /// What is known about one loop.
  struct State {
    bool accepted = false;
    bool connected = false;
    bool on_trial = false;  // may only be accepted once nothing else can
    int round = 0;
    int drops = 0;
    // Of T_a^-1 T_b as predicted by the other accepted loops, or for an accepted loop
    // by all of them: as last solved for, and so an upper bound. What is known of an
    // accepted loop is lost when bounds are forgotten.
    Matrix covariance = Matrix::Zero();
    bool fit_known = false;
    Evidence evidence;
  };
  struct Batch {
    std::string rule;
    Selection loops;
  };

  /// What a search can be taken back to.
  struct Snapshot {
    std::vector<State> states;
    std::vector<bool> accepted;
    std::size_t rounds = 0;
    typename Estimate<Pose>::Layout layout;
  };

  bool reconsider();
  Selection held_by_themselves();
  std::size_t freed_without(const Selection& loops);
  Snapshot snapshot() const;
  void restore(Snapshot before);
  std::int64_t accepted_count() const;

  void accept_and_calibrate(int most_calibrations);
  bool odometry_leaves_none() const;
  void accept_while_possible();
  bool accept_next_batch();
  bool readmit();
  void settle();
  void drop(Index loop);
  void forget_bounds();
  bool drop_inconsistent();
  void assess();
  void weigh_afresh(const Selection& loops);
  Evidence weigh_loop(Index loop, const Matrix& covariance) const;
  bool refuted(Index loop) const { return !accepted_[loop] && !inside_gate(loop); }

  Selection in_question() const;
  Batch next_batch() const;
  Selection bridges(const Selection& eligible, const std::vector<double>& odds) const;
  std::vector<double> log_odds() const;
  double log_odds(Index loop, const Evidence& evidence) const;
  void accept(const Batch& batch);
  void learn_from_decided();
  bool calibrate();
  void judge_anew();
  Index span(Index loop) const;
  double drop_gate() const;
  void tell_progress() const;
  void report(ConsensusResult& result) const;
  bool inside_gate(Index loop) const { return states_[loop].evidence.chi2 <= gate_; }

  const ReducedGraph<Pose>& graph_;
  const ConsensusOptions& options_;
  double gate_;           // chi-squared of a correct loop stays below it
  double required_odds_;  // log odds from which a loop counts as proven
  MapVolume<Pose> map_;
  Estimate<Pose> estimate_;
  std::vector<std::pair<Index, Index>> near_pairs_;
  Calibration<Pose> calibration_;
  MutualSupport support_;
  std::vector<State> states_;
  std::vector<bool> accepted_;
  std::vector<ConsensusRound> rounds_;
  PriorBySpan prior_;
  double alike_fraction_ = 0.2;  // of false loops that agree with a neighbouring false loop
  bool take_likely_ = false;     // accept unproven loops that are more likely true than not
  bool settled_ = true;
};

extern template class Search<Pose2>;
extern template class Search<Pose3>;

}  // namespace isotherm::slam::detail
