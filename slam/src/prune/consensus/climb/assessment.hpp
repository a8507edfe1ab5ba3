#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "prune/consensus/objective/loop_gain.hpp"
#include "prune/consensus/objective/objective.hpp"
#include "prune/consensus/objective/standing.hpp"
#include "prune/consensus/runs/false_loops.hpp"

namespace isotherm::slam::detail {

/// Finds the peak of an explanation, its evidence there, and what each loop is worth given all
/// others. Goes from one explanation to the next: what has not changed is not computed again.
template <class Pose>
class Assessment {
 public:
  using Matrix = typename Pose::Matrix;
  using Tangent = typename Pose::Tangent;

  /// `objective` must outlive this object. Loops are weighed on `threads` threads (0: all cores).
  explicit Assessment(const Objective<Pose>& objective, Pace pace = {}, int threads = 1);

  /// Back to the layout of odometry.
  void start_over();

  /// Whether the density of near pairs is found anew only where the loops that are accepted are
  /// many more or fewer: it changes slowly, and takes longest on small graphs. Many loops may draw
  /// the map together.
  void hold_nearness(bool held) { nearness_held_ = held; }

  /// While what this returns lives, loops are weighed as if scales were known.
  [[nodiscard]] auto as_if_scales_were_known() {
    scales_known_ = true;
    const auto no_more = [](bool* known) { *known = false; };
    return std::unique_ptr<bool, decltype(no_more)>(&scales_known_, no_more);
  }
  bool scales_are_known() const noexcept { return scales_known_; }

  /// Where the map may become another though the same loops are accepted.
  void forget_nearness() { found_.near_of.reset(); }

  /// How often that was found so far, of how many assessments, and the work of each time, as pace
  /// is told, which is the same on every graph.
  struct NearnessFound {
    double times = 0.0;
    double assessments = 0.0;
    static constexpr double kWork = 2500.0;  // links that are linearised in that time (measured)
  };
  const NearnessFound& nearness_found() const noexcept { return nearness_found_; }

  /// Sets the weights, the layout and the evidence of `now`, or gives up where that does not reach
  /// `least`: whether it went to the end.
  /// @throws NumericalError if the normal equations break down
  bool assess(Explanation<Pose>& now, double least = -std::numeric_limits<double>::infinity());

  /// The same from a map that does not depend on the one where `now` was assessed; gives up, too,
  /// where that leads back to it.
  bool assess_on_another_map(Explanation<Pose>& now, double least);

  /// What the next assessment starts from, beside the explanation.
  struct Findings {
    Shapes<Pose> shapes;
    std::shared_ptr<const ScaledGraph<Pose>> graph;  // scaled by those
    ScaleMixture mixture;
    typename Objective<Pose>::NearByClass near{};
    std::optional<std::size_t> near_of;  // loops that were accepted then; none: to be found anew
    std::vector<Matrix> covariances;     // of residuals, one a loop; with it where it is accepted
    std::vector<Tangent> shifts;         // what those are more for what odometry's bias is likely
    // Information of the loops that the covariances are given; none where empty.
    std::vector<Matrix> held;
    std::shared_ptr<const std::vector<Belief<Pose>>> steps;  // of odometry's residuals, if any
    std::vector<double> run_density;                         // run_density()
    std::vector<double> log_place;                           // Objective::log_place()
    FalseLoops false_loops;
  };
  const Findings& findings() const noexcept { return found_; }

  /// Back to where an earlier assessment ended, with what was found there.
  void restore(const Explanation<Pose>& before, Findings found);

  /// The next assessment starts from this layout.
  void stand_on(const typename Estimate<Pose>::Layout& layout) { estimate_.restore(layout); }

  const Objective<Pose>& objective() const noexcept { return objective_; }

  const Estimate<Pose>& estimate() const noexcept { return estimate_; }

  const ReducedGraph<Pose>& graph() const noexcept { return found_.graph->reduced; }

  /// Edges of odometry that are likely to err more than others, or no more; none where nothing but
  /// odometry is known.
  std::vector<SlipChange> slip_changes(const Explanation<Pose>& now) const;

  /// Of a loop's residual.
  Belief<Pose> belief(Index loop) const {
    return {estimate_.residual(graph().loops[loop]) + found_.shifts[loop],
            found_.covariances[loop]};
  }

  // Of the logs of the scales, by what is left to tell them.
  CovarianceScale scale_deviation(const Redundancy<Pose>& told) const {
    return scales_known_ ? CovarianceScale{0.0, 0.0} : objective_.scale_deviation(told);
  }

  /// How much of each coordinate of an accepted loop is left to tell how accurate it is:
  /// diag(I - Omega P), Omega its mean information, P the residual's covariance.
  typename Pose::Tangent redundancy(const Explanation<Pose>& now, Index loop) const;

  /// log of how much likelier it is before anything is measured that these loops, ascending, are
  /// all true than that all are false, if the others are as in `now`.
  double log_prior_odds(const Explanation<Pose>& now, std::span<const Index> loops) const;

  /// log of how much likelier it is than by chance that these loops, ascending, are false with
  /// those around them in their runs that are.
  double log_false_run(std::span<const Index> loops) const;

  /// log of the density that a loop's is held against.
  double log_alternative(Index loop) const {
    return objective_.log_alternative(loop, found_.near, found_.mixture.scale);
  }

  /// log of how much likelier true than false a loop is if the one before it in its run is true.
  double log_led(Index loop) const {
    return found_.run_density[loop] - log_alternative(loop) - log_alone(found_.log_place[loop]);
  }

 private:
  void rescale(const Shapes<Pose>& shapes);
  void find_peak(Explanation<Pose>& now);
  bool weigh_peak(Explanation<Pose>& now, double least);
  void settle(Explanation<Pose>& now);
  void turn_by(const TurnBias<Pose>& bias, Explanation<Pose>& now);
  std::vector<std::vector<Pose>> drawn_maps(const CovarianceScale& scale) const;
  void find_nearness(const Explanation<Pose>& now);
  void find_places(const Explanation<Pose>& now, const std::vector<std::vector<Pose>>& maps);
  double log_alone(double log_place) const { return found_.false_loops.log_alone(log_place); }
  bool reweigh(Explanation<Pose>& now, bool anyway);
  Matrix information(const Explanation<Pose>& now, Index loop) const {
    return objective_.information(now, *found_.graph, loop);
  }
  std::vector<Matrix> accepted_information(const Explanation<Pose>& now) const;
  Matrix uncertainty(const Explanation<Pose>& now, Index loop) const;
  Misfit misfit(const Explanation<Pose>& now, Index loop) const;
  OwnError<Pose> own_error(Index loop) const {
    return {graph().loops[loop].covariance, objective_.stated().reduced.loops[loop].covariance};
  }
  void weigh_new(Explanation<Pose>& now);
  std::vector<Index> predict(Explanation<Pose>& now);
  Matrix odometry_says(Index loop, double scale) const;
  void believe(Index loop, const Matrix& covariance);
  void solve(Explanation<Pose>& now, const std::vector<Index>& accepted,
             const std::vector<Index>& bounded);
  std::vector<char> predict_others(Explanation<Pose>& now, std::vector<Index> bounded);
  bool refute(Explanation<Pose>& now, Index loop) const;
  typename Estimate<Pose>::Links links_of(const std::vector<Index>& loops) const;
  void follow_runs(const Explanation<Pose>& now);
  void weigh(Explanation<Pose>& now, const std::vector<char>& refuted);
  void find_redundancy(Explanation<Pose>& now) const;
  Standing accepted_standing(const Explanation<Pose>& now, Index loop) const;
  Standing other_standing(const Explanation<Pose>& now, Index loop) const;
  void add_prior(Explanation<Pose>& now) const;

  const Objective<Pose>& objective_;
  Pace pace_;
  int threads_;
  Findings found_;
  Estimate<Pose> estimate_;
  std::optional<BiasFit<Pose>> bias_;  // at the peak
  typename Estimate<Pose>::Layout odometry_;
  bool nearness_held_ = false;
  bool scales_known_ = false;
  NearnessFound nearness_found_;
};

extern template class Assessment<Pose2>;
extern template class Assessment<Pose3>;

}  // namespace isotherm::slam::detail
