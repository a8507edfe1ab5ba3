#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "prune/consensus/objective/objective.hpp"
#include "prune/consensus/objective/standing.hpp"

namespace isotherm::slam::detail {

/// Finds the peak of an explanation, its evidence there, and what each loop is worth given all
/// others. Goes from one explanation to the next: what has not changed is not computed again.
template <class Pose>
class Assessment {
 public:
  using Matrix = typename Pose::Matrix;

  /// `objective` must outlive this object.
  explicit Assessment(const Objective<Pose>& objective, Pace pace = {});

  /// Back to the layout of odometry.
  void start_over();

  /// Whether the density of near pairs stays what it was found to be, whatever the layout: that
  /// changes slowly, and takes longest on small graphs.
  void hold_nearness(bool held) { nearness_held_ = held; }

  /// Work so far, as pace is told, on that density, which takes the same on every graph.
  double nearness_work() const noexcept { return nearness_work_; }

  /// Sets the weights, the layout and the evidence of `now`, or gives up where that cannot reach
  /// `least`: whether it went to the end.
  /// @throws NumericalError if the normal equations break down
  bool assess(Explanation<Pose>& now, double least = -std::numeric_limits<double>::infinity());

  /// What the next assessment starts from, beside the explanation.
  struct Findings {
    Shapes<Pose> shapes;
    std::shared_ptr<const ScaledGraph<Pose>> graph;  // scaled by those
    ScaleMixture mixture;
    typename Objective<Pose>::NearByClass near{};
    std::vector<Matrix> covariances;  // of T_a^-1 T_b, one a loop; with it where it is accepted
    // Factors on the information of the loops that the covariances are given; none where empty.
    std::vector<double> held;
    double held_scale = 0.0;  // of odometry
  };
  const Findings& findings() const noexcept { return found_; }

  /// Back to where an earlier assessment ended, with what was found there.
  void restore(const Explanation<Pose>& before, Findings found);

  const Estimate<Pose>& estimate() const noexcept { return estimate_; }

  const ReducedGraph<Pose>& graph() const noexcept { return found_.graph->reduced; }

  /// How much of each coordinate of an accepted loop is left to tell how accurate it is:
  /// diag(I - w Omega J C J').
  typename Pose::Tangent redundancy(const Explanation<Pose>& now, Index loop) const;

  /// log of the density that a loop's is held against.
  double log_alternative(Index loop) const {
    return objective_.log_alternative(loop, found_.near, found_.mixture.scale, found_.shapes.loops);
  }

 private:
  void rescale(const Shapes<Pose>& shapes);
  void find_peak(Explanation<Pose>& now);
  void find_nearness();
  double ceiling(Explanation<Pose>& now) const;
  double evidence(const Explanation<Pose>& now) const;
  bool reweigh(Explanation<Pose>& now);
  double uncertainty(const Explanation<Pose>& now, Index loop) const;
  void weigh_new(Explanation<Pose>& now);
  bool bounds(const Explanation<Pose>& now) const;
  void predict(Explanation<Pose>& now);
  void weigh(Explanation<Pose>& now);
  void find_redundancy(Explanation<Pose>& now) const;
  Standing accepted_standing(const Explanation<Pose>& now, Index loop) const;
  Standing other_standing(const Explanation<Pose>& now, Index loop, bool best) const;
  void add_prior(Explanation<Pose>& now) const;

  const Objective<Pose>& objective_;
  Pace pace_;
  Findings found_;
  Estimate<Pose> estimate_;
  typename Estimate<Pose>::Layout odometry_;
  bool nearness_held_ = false;
  double nearness_work_ = 0.0;
};

extern template class Assessment<Pose2>;
extern template class Assessment<Pose3>;

}  // namespace isotherm::slam::detail
