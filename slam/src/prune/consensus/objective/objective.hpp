#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "prune/consensus/constants.hpp"
#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/log_odds.hpp"
#include "prune/consensus/objective/error_scales.hpp"
#include "prune/consensus/objective/near_density.hpp"
#include "prune/consensus/objective/scale_prior.hpp"
#include "prune/consensus/objective/scaled_graph.hpp"
#include "prune/consensus/objective/standing.hpp"
#include "prune/consensus/odometry/bias_fit.hpp"
#include "prune/consensus/odometry/odometry_component.hpp"
#include "prune/consensus/odometry/slip_changes.hpp"
#include "prune/consensus/runs/labels.hpp"
#include "prune/consensus/runs/runs.hpp"

namespace isotherm::slam::detail {

/// How many of the numbers measured are left to tell how accurate they are.
template <class Pose>
struct Redundancy {
  typename Pose::Tangent odometry = Pose::Tangent::Zero();  ///< by coordinate
  typename Pose::Tangent loops = Pose::Tangent::Zero();     ///< of those accepted
};

/// What explains the measurements: which loops are true, and how accurate everything is.
/// A plain value; a trial is a copy.
template <class Pose>
struct Explanation {
  std::vector<bool> accepted;  ///< one a loop
  CovarianceScale scale;       ///< factors on the stated covariances; of loops, that of most
  Shapes<Pose> shapes;
  ScaleShares shares;               ///< of loops by how accurate they are, as believed
  ScaleShares found;                ///< the same, as found among the accepted ones
  std::vector<LoopWeight> weights;  ///< by their scales; one a loop
  double scale_evidence = 0.0;      ///< ErrorScale::evidence, summed over the accepted ones
  Redundancy<Pose> redundancy;      ///< of odometry and of the accepted loops of scales learnt
  typename Pose::Tangent odometry_cost = Pose::Tangent::Zero();  ///< OdometryComponent::cost
  typename Estimate<Pose>::Layout layout;
  std::vector<Standing> standings;  ///< of each loop, given all others
  LabelCounts labels;               ///< of loops that are true and false, as expected
  double evidence = 0.0;            ///< see Objective

  std::size_t accepted_count() const {
    return static_cast<std::size_t>(std::ranges::count(accepted, true));
  }

  bool accepts_all() const { return accepted_count() == accepted.size(); }

  /// Loops that are not what is taken for true or false here, as expected.
  double expected_wrong(const std::vector<bool>& are_true) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < are_true.size(); ++k) {
      sum += probability_of(are_true[k] ? -standings[k].log_odds : standings[k].log_odds);
    }
    return sum;
  }

  /// Whether any number measured is left to tell how accurate measurements are.
  bool tells_of_scales() const { return redundancy.odometry.sum() + redundancy.loops.sum() >= 1.0; }

  /// What is expected of how accurate the next loop is.
  ScaleMixture mixture() const {
    return expected_mixture(scale.loops, shares, shapes.loops.minCoeff());
  }
};

/// That of the highest evidence; `found` must hold one.
template <class Pose>
const Explanation<Pose>& best_of(const std::vector<Explanation<Pose>>& found) {
  return *std::ranges::max_element(found, {}, &Explanation<Pose>::evidence);
}

/// The log evidence of an explanation: of the accepted set A and the scales,
///
///     log p(z_A, odometry | scales) - sum over A of (log f_mean + log f(z) - log f(h))
///         + log r(the others) + log pi(A) + log pi(scales)
///
/// with p by Laplace's approximation from the factor that the estimate holds, without what does not
/// depend on A and the scales (of odometry without cycles that is all of its own: p is that of z_A
/// given odometry), f_mean, f(z) and f(h) as in NearDensity, r as in log_follows, pi(A) as in
/// LabelCounts. The scales are log-normal around what the file states (scale_prior.hpp) and
/// integrated over by Laplace's approximation. Which loops are as accurate as most and which less
/// (ScaleShares) is integrated out by variational Bayes (Bishop, Pattern Recognition and Machine
/// Learning, 10.1), which gives a lower bound. A part that A joins to another lies anywhere on the
/// map.
///
/// The same number is what accepting the loops one by one adds (loop_gain), in any order.
template <class Pose>
class Objective {
 public:
  using NearByClass = std::array<double, kProposalClasses>;

  /// Loops whose ends lie within `window` vertices of another's can be in one run. Without
  /// `calibrate` the scales are known.
  Objective(const PoseGraph<Pose>& graph, const EdgeRoles& roles, Index window,
            bool calibrate = true);

  /// The same of some of its loops, by their numbers, ascending.
  Objective of(const std::vector<Index>& loops) const;

  /// As stated.
  const ScaledGraph<Pose>& stated() const noexcept { return stated_; }
  ScaledGraph<Pose> scaled(const Shapes<Pose>& shapes) const {
    return scaled_graph(graph_, roles_, chain_, shapes);
  }
  const Runs<Pose>& runs() const noexcept { return runs_; }
  std::size_t odometry_edges() const noexcept { return chain_.size(); }
  /// How many measurements of odometry there are, repeated ones and all.
  double odometry_count() const noexcept { return static_cast<double>(roles_.odometry.size()); }

  /// Logs of the factors on odometry's variances at most, by coordinate: of larger errors its steps
  /// would vary more than they do (StepSpread).
  const typename Pose::Tangent& most_odometry() const noexcept { return most_odometry_; }

  /// The mean inverse of a loop's covariance, by its weight.
  typename Pose::Matrix information(const Explanation<Pose>& now, const ScaledGraph<Pose>& graph,
                                    Index loop) const {
    return information(now, graph, loop, now.weights[loop]);
  }
  typename Pose::Matrix information(const Explanation<Pose>& now, const ScaledGraph<Pose>& graph,
                                    Index loop, const LoopWeight& weight) const {
    const auto& [learnt, stated] = weight;
    return learnt / now.scale.loops * graph.reduced.loops[loop].information +
           stated * stated_.reduced.loops[loop].information;
  }

  /// See NearDensity::log_mean().
  NearByClass near(const std::vector<std::vector<Pose>>& maps) const {
    return near_.log_mean(maps);
  }

  /// The density that a loop's is held against: that of loops near by chance; for one that
  /// copies the measurement of the one before it in its run, that of a copy, so that a group
  /// of copies counts as one draw, but no less: where loops are taken for so inaccurate that any
  /// copy fits, each is as likely a draw of its own.
  double log_alternative(Index loop, const NearByClass& near, double loop_scale) const;

  /// What NearDensity::log_nearer() says of a loop that the map leaves the residual r; of a copy
  /// nothing, since what it measures was drawn with another.
  double log_nearer(Index loop, const typename Pose::Tangent& r, double tail_dof = kTailDof) const;

  /// log of how much likelier than by chance a false loop of the right place is, where its ends lie
  /// as `belief` has it, or as on one of these maps, `near` by chance: it is proposed as a true one
  /// is, and measured as in log_wrong(). Of a copy 0, since its ends were proposed with another's.
  double log_place(const Explanation<Pose>& now, const ScaledGraph<Pose>& graph, Index loop,
                   const Belief<Pose>& belief, const NearByClass& near) const;
  double log_place(const Explanation<Pose>& now, const ScaledGraph<Pose>& graph, Index loop,
                   const std::vector<std::vector<Pose>>& maps, const NearByClass& near) const;

  /// See NearDensity::log_mean_around(): around loops that lead others.
  double log_mean_around() const noexcept { return log_mean_around_; }

  const NearDensity<Pose>& near_density() const noexcept { return near_; }

  /// Of the logs of the factors on covariances that measurements of this redundancy tell.
  CovarianceScale scale_deviation(const Redundancy<Pose>& redundancy) const {
    if (!calibrate_) return {0.0, 0.0};
    return {detail::scale_deviation(redundancy.odometry.sum()),
            detail::scale_deviation(redundancy.loops.sum())};
  }

  /// By the residuals of the steps of `graph` where the explanation's loops and scales agree best.
  OdometryComponent<Pose> odometry(const Explanation<Pose>& explanation,
                                   const ScaledGraph<Pose>& graph,
                                   std::span<const Belief<Pose>> steps, int threads = 1) const {
    return odometry_component<Pose>(contracted(explanation, graph), explanation.scale.odometry,
                                    steps, threads);
  }

  /// Edges of odometry that are likely to err more than others, or no more. As odometry().
  std::vector<SlipChange> slip_changes(const Explanation<Pose>& explanation,
                                       const ScaledGraph<Pose>& graph,
                                       std::span<const Belief<Pose>> steps, int threads = 1) const {
    return detail::slip_changes<Pose>(contracted(explanation, graph), explanation.scale.odometry,
                                      log_slip_odds(explanation.shapes.slips, chain_.size()), steps,
                                      threads);
  }

  /// Of odometry's bias, where its errors are as in the explanation: normal, by the mean variance
  /// of a step's.
  BiasPrior<Pose> bias_prior(const Explanation<Pose>& explanation,
                             const ScaledGraph<Pose>& graph) const;

  /// log of the volume of relative poses that the map of odometry allows.
  double log_volume() const noexcept { return log_volume_; }

  /// The evidence, but for what log_scale_peak(), BiasFit::log_evidence() and false_loops() say.
  /// `estimate` must have settled on the explanation's loops, scales and weights, on `graph`.
  double fit(const Explanation<Pose>& explanation, const ScaledGraph<Pose>& graph,
             const Estimate<Pose>& estimate, const NearByClass& near) const;

  /// log of the prior at the scales and of edges that err more times the width of the peak there,
  /// which is as narrow as redundancy has it, and of how likely steps of odometry are that vary as
  /// little as they do.
  double log_scale_peak(const Explanation<Pose>& explanation) const;

 private:
  double log_slips(const Explanation<Pose>& explanation) const;
  ContractedChain<Pose> contracted(const Explanation<Pose>& explanation,
                                   const ScaledGraph<Pose>& graph) const {
    const auto& [odometry, loops, slips, bias, slip_scale] = explanation.shapes;
    return {chain_, odometry, slips, bias, graph.reduced};
  }
  double loops_fit(const Explanation<Pose>& explanation, const ScaledGraph<Pose>& graph,
                   const Estimate<Pose>& estimate) const;

  PoseGraph<Pose> graph_;  // in_own_frames()
  EdgeRoles roles_;
  Chain<Pose> chain_;
  ScaledGraph<Pose> stated_;
  NearDensity<Pose> near_;
  Runs<Pose> runs_;
  double log_mean_around_;
  Index window_;
  bool calibrate_;
  typename Pose::Tangent most_odometry_;
  typename Pose::Tangent step_variance_;  // mean, as stated
  double log_volume_;
  std::vector<double> log_sigma_;  // log|Sigma| of each loop
};

extern template class Objective<Pose2>;
extern template class Objective<Pose3>;

}  // namespace isotherm::slam::detail
