#pragma once

#include <vector>

#include "prune/consensus/climb/standing.hpp"
#include "prune/consensus/objective/objective.hpp"

namespace isotherm::slam::detail {

/// Finds the peak of an explanation, its evidence there, and what each loop is worth given all
/// others. Goes from one explanation to the next: what has not changed is not computed again.
template <class Pose>
class Assessment {
 public:
  using Matrix = typename Pose::Matrix;

  /// `objective` must outlive this object.
  explicit Assessment(const Objective<Pose>& objective);

  /// Back to the layout of odometry.
  void start_over();

  /// Sets the weights, the layout and the evidence of `now`.
  /// @throws NumericalError if the normal equations break down
  void assess(Explanation<Pose>& now);

  /// Takes `before`, assessed earlier, as what the next one starts from.
  void restore(const Explanation<Pose>& before);

  const std::vector<Standing>& standings() const noexcept { return standings_; }
  const Estimate<Pose>& estimate() const noexcept { return estimate_; }

  const ReducedGraph<Pose>& graph() const noexcept { return graph_.reduced; }

  /// How much of each coordinate of an accepted loop is left to tell how accurate it is:
  /// diag(I - w Omega J C J').
  typename Pose::Tangent redundancy(const Explanation<Pose>& now, Index loop) const;

  /// log of the density that a loop's is held against.
  double log_alternative(Index loop) const {
    return objective_.log_alternative(loop, near_, mixture_.scale, shapes_.loops);
  }

 private:
  void rescale(const Shapes<Pose>& shapes);
  void find_peak(Explanation<Pose>& now);
  bool reweigh(Explanation<Pose>& now);
  double uncertainty(const Explanation<Pose>& now, Index loop) const;
  void weigh_new(Explanation<Pose>& now);
  void bound(const Explanation<Pose>& now);
  void weigh(Explanation<Pose>& now);
  void find_redundancy(Explanation<Pose>& now) const;
  Standing accepted_standing(const Explanation<Pose>& now, Index loop) const;
  Standing other_standing(const Explanation<Pose>& now, Index loop, bool solved) const;
  void add_prior(const std::vector<bool>& accepted);

  const Objective<Pose>& objective_;
  ScaledGraph<Pose> graph_;
  Shapes<Pose> shapes_;  // that graph_ is scaled by
  Estimate<Pose> estimate_;
  typename Estimate<Pose>::Layout odometry_;
  ScaleMixture mixture_;
  typename Objective<Pose>::NearByClass near_{};
  std::vector<Standing> standings_;
  std::vector<Matrix> covariances_;  // of T_a^-1 T_b, one a loop; with it where it is accepted
  std::vector<bool> held_;           // loops that the covariances are given, for
  double held_scale_ = 0.0;          // of odometry
};

extern template class Assessment<Pose2>;
extern template class Assessment<Pose3>;

}  // namespace isotherm::slam::detail
