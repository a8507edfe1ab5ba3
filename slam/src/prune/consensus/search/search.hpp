#pragma once

#include <string>
#include <vector>

#include "isotherm/slam/prune/consensus.hpp"
#include "prune/consensus/calibrate/calibration.hpp"
#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/estimate/map_volume.hpp"
#include "prune/consensus/estimate/reduced_graph.hpp"
#include "prune/consensus/judge/judge.hpp"
#include "prune/consensus/pairs/agreement.hpp"
#include "prune/consensus/pairs/mutual_support.hpp"

namespace isotherm::slam::detail {

/// The state of forward consensus between two rounds.
template <class Pose>
class Search {
 public:
  using Selection = std::vector<Index>;
  using Pairs = typename Calibration<Pose>::Pairs;

  /// `pairs` are the loops near each other (near_pairs). All four must outlive this object.
  /// Covariances are only tightened unless `may_widen`.
  Search(const ReducedGraph<Pose>& graph, const Pairs& pairs, const ConsensusOptions& options,
         const RunContext& run, bool may_widen);

  /// Runs to the end.
  void run();

  /// Whether what was accepted asks for wider covariances than the file states, or nothing
  /// was.
  bool asks_for_wider() const;

  /// How many of the accepted loops the others prove, held out, on the map that they make.
  std::int64_t count_proven() const;

  /// Fills in everything in `result` but the verdicts' edges.
  void report(ConsensusResult& result) const;

 private:
  /// What was decided about one loop.
  struct Record {
    bool on_trial = false;  // may only be accepted once nothing else can
    int round = 0;
    int drops = 0;
  };
  struct Batch {
    std::string rule;
    Selection loops;
  };

  /// What a search can be taken back to.
  struct Snapshot {
    std::vector<typename Judge<Pose>::Standing> standings;
    std::vector<Record> records;
    std::vector<bool> accepted;
    std::size_t rounds = 0;
    typename Estimate<Pose>::Layout layout;
  };

  bool few_parts() const;
  bool join_on_trial();
  std::size_t witnesses(const std::vector<Selection>& groups, std::size_t tried);
  bool reconsider();
  void readmit_together();
  void doubt_company();
  std::size_t freed_without(const Selection& loops);
  Snapshot snapshot() const;
  void restore(Snapshot before);

  void accept_and_calibrate(int most_calibrations);
  bool odometry_leaves_none() const;
  void accept_while_possible();
  bool readmit();
  void settle();
  void assess();

  Selection in_question() const;
  Batch next_batch() const;
  Selection bridges(const Selection& eligible, const std::vector<double>& odds) const;
  bool accept(const Batch& batch);
  Batch clusters_of(const Selection& eligible, const std::vector<double>& odds) const;
  void learn_from_decided();
  bool calibrate();
  std::vector<double> probabilities() const;
  void judge_anew();
  std::int64_t accepted_count() const;
  void tell_progress() const;

  const ReducedGraph<Pose>& graph_;
  const ConsensusOptions& options_;
  const RunContext& run_;
  double required_odds_;  // log odds from which a loop counts as proven
  MapVolume<Pose> map_;
  Estimate<Pose> estimate_;
  const Pairs& near_pairs_;
  Calibration<Pose> calibration_;
  MutualSupport support_;
  std::vector<Record> records_;
  std::vector<bool> accepted_;
  Judge<Pose> judge_;
  std::vector<ConsensusRound> rounds_;
  Agreement agreement_;
  bool take_likely_ = false;  // accept unproven loops that are more likely true than not
  bool closing_ = false;      // tries nothing new, but looks at every loop once more
  bool settled_ = true;
};

extern template class Search<Pose2>;
extern template class Search<Pose3>;

}  // namespace isotherm::slam::detail
