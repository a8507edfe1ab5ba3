#pragma once

#include <algorithm>
#include <vector>

#include "prune/consensus/calibrate/calibration.hpp"
#include "prune/consensus/calibrate/heavy_tail.hpp"
#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/estimate/map_volume.hpp"
#include "prune/consensus/estimate/reduced_graph.hpp"
#include "prune/consensus/judge/crowded_gate.hpp"
#include "prune/consensus/judge/prior_by_span.hpp"

namespace isotherm::slam::detail {

/// What odometry and the accepted loops say of every loop.
template <class Pose>
class Judge {
 public:
  using Matrix = typename Pose::Matrix;
  using Selection = std::vector<Index>;

  /// How one loop stands.
  struct Standing {
    bool connected = false;
    // Of T_a^-1 T_b as predicted by the other accepted loops, or for an accepted loop
    // by all of them: as last solved for, and so an upper bound. What is known of an
    // accepted loop is lost when bounds are forgotten.
    Matrix covariance = Matrix::Zero();
    bool fit_known = false;
    Evidence evidence;
  };

  /// All must outlive this object. `accepted` has one entry a loop; a correct loop is
  /// beyond the gate with probability `significance`.
  Judge(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
        const Calibration<Pose>& calibration, const MapVolume<Pose>& map,
        const std::vector<bool>& accepted, double significance);

  /// Beyond it a correct loop lies with the probability `significance`.
  double widest_gate() const noexcept { return widest_gate_; }

  /// What a loop must meet to be accepted: narrower where false loops crowd around the
  /// widest gate.
  double gate(Index loop) const { return gates_[span_class(graph_.span(loop))]; }

  /// Whether false loops crowd there, of whatever span.
  bool crowded() const;

  /// Beyond it a loop that is not accepted is refuted. Where false loops crowd it is in doubt
  /// between both gates: few correct loops of Gaussian errors are beyond this one.
  double refuting_gate(Index loop) const;

  /// Once nothing more can be proven: loops that are likelier false by their evidence are held
  /// to the gate of where false ones crowd.
  void suspect_unlikely() { suspicious_ = true; }

  /// From now on holds `loops` to a gate that all but one in a hundred correct ones meet.
  void doubt(const Selection& loops);

  /// How many times farther out than for Gaussian errors the accepted loops may lie.
  double tail_factor() const;

  /// The gate of accepted loops: real errors have heavy tails, and where a loop was
  /// accepted it had evidence of its own.
  double drop_gate(Index loop) const;

  const Evidence& evidence(Index loop) const { return standings_[loop].evidence; }
  bool connected(Index loop) const { return standings_[loop].connected; }
  bool inside_gate(Index loop) const {
    return evidence(loop).chi2 <= std::min(gate(loop), refuting_gate(loop));
  }
  bool refuted(Index loop) const {
    return !accepted_[loop] && evidence(loop).chi2 > refuting_gate(loop);
  }

  /// Prior and evidence of a loop; of all.
  double log_odds(Index loop, const Evidence& evidence) const;
  std::vector<double> log_odds() const;

  /// Fraction of true loops among those decided.
  double inlier_fraction() const noexcept { return prior_.fraction(); }

  /// Weighs every loop that is not accepted; solves for those that an old bound does
  /// not refute.
  void assess();

  /// Solves for `loops` and weighs them.
  void weigh_afresh(const Selection& loops);

  /// Of the accepted loops, as a share of the gate, at most 1: where it is below, loops
  /// are more accurate than stated, heavy tails included.
  double tail_share() const { return std::min(1.0, tail_.quantile / widest_gate_); }

  /// The accepted loops that disagree most with the others; none if all agree.
  Selection inconsistent();

  /// Accepted loops that the others prove by less than `required_odds`.
  Selection held_by_themselves(double required_odds) const;

  /// Takes into account that `loop` has been accepted.
  void sharpen(Index loop);

  /// Once a loop is dropped or the scales change, predictions may be wider than any
  /// since odometry alone.
  void forget_bounds();

  /// The prior, from the accepted loops and the refuted ones.
  void learn_prior();

  const std::vector<Standing>& standings() const noexcept { return standings_; }
  void restore(std::vector<Standing> before) { standings_ = std::move(before); }

 private:
  Evidence weigh(Index loop) const;
  Selection misfits();
  void learn_tail();
  void learn_gate();
  double tail_gate() const;

  const ReducedGraph<Pose>& graph_;
  const Estimate<Pose>& estimate_;
  const Calibration<Pose>& calibration_;
  const MapVolume<Pose>& map_;
  const std::vector<bool>& accepted_;
  double significance_;
  double widest_gate_;
  double narrowest_refuting_gate_;  // where false loops crowd, or one looks like it
  GateBySpan gates_;
  double doubtful_share_;  // of a gate, for loops in doubt
  bool suspicious_ = false;
  std::vector<bool> doubtful_;
  Tail tail_;
  std::vector<Standing> standings_;
  PriorBySpan prior_;
};

extern template class Judge<Pose2>;
extern template class Judge<Pose3>;

}  // namespace isotherm::slam::detail
