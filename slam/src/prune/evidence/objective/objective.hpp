#pragma once

#include <array>
#include <vector>

#include "prune/consensus/estimate/estimate.hpp"
#include "prune/evidence/objective/error_scales.hpp"
#include "prune/evidence/objective/near_density.hpp"
#include "prune/evidence/objective/runs.hpp"

namespace isotherm::slam::detail {

/// What explains the measurements: which loops are true, and how accurate everything is.
/// A plain value; a trial is a copy.
template <class Pose>
struct Explanation {
  std::vector<bool> accepted;   ///< one a loop
  CovarianceScale scale;        ///< factors on the stated covariances; of loops, that of most
  ScaleShares shares;           ///< of loops as accurate as most and as stated, as believed
  ScaleShares found;            ///< the same, as found among the accepted ones
  std::vector<double> weights;  ///< of the loops' information, by their scales; one a loop
  double scale_evidence = 0.0;  ///< ErrorScale::evidence, summed over the accepted ones
  typename Estimate<Pose>::Layout layout;
  double evidence = 0.0;  ///< Objective::evidence()
};

/// The log evidence of an explanation: of the accepted set A and the scales,
///
///     log p(z_A | odometry, scales) - sum over A of log (f k_mean / k)
///         + log pi(A) + log pi(scales)
///
/// with p by Laplace's approximation from the factor that the estimate holds, f and k as in
/// NearDensity, pi(A) the Beta-binomial of a fraction of which nothing is known. The scales are
/// log-normal around what the file states, a factor of ten in the standard deviation being one
/// deviation. Which loops are as accurate as most and which as stated (ScaleShares) is integrated
/// out by variational Bayes (Bishop, Pattern Recognition and Machine Learning, 10.1), which gives a
/// lower bound. A part that A joins to another lies anywhere on the map.
///
/// The same number is what accepting the loops one by one adds (loop_gain), in any order.
template <class Pose>
class Objective {
 public:
  using NearByClass = std::array<double, kProposalClasses>;

  /// `graph` must outlive this object. Loops whose ends lie within `window` vertices of
  /// another's can be in one run.
  Objective(const ReducedGraph<Pose>& graph, Index window);

  const ReducedGraph<Pose>& graph() const noexcept { return graph_; }
  const Runs<Pose>& runs() const noexcept { return runs_; }

  /// log k_mean of each class of loops on the map with nodes at `poses`.
  NearByClass near(const std::vector<Pose>& poses) const { return near_.log_mean(poses); }

  /// The density that a loop's is held against: that of loops near by chance; for one that
  /// copies the measurement of the one before it in its run, that of a copy, so that a group
  /// of copies counts as one draw.
  double log_alternative(Index loop, const NearByClass& near, double loop_scale) const;

  /// log of the volume of relative poses that the map of odometry allows.
  double log_volume() const noexcept { return log_volume_; }

  /// `estimate` must have settled on the explanation's loops, scales and weights.
  double evidence(const Explanation<Pose>& explanation, const Estimate<Pose>& estimate,
                  const NearByClass& near) const;

 private:
  double loops_fit(const Explanation<Pose>& explanation, const Estimate<Pose>& estimate) const;

  const ReducedGraph<Pose>& graph_;
  NearDensity<Pose> near_;
  Runs<Pose> runs_;
  double log_volume_;
  double odometry_log_determinant_ = 0.0;
  Index odometry_variables_ = 0;
  std::vector<double> log_sigma_;  // log|Sigma| of each loop
};

extern template class Objective<Pose2>;
extern template class Objective<Pose3>;

}  // namespace isotherm::slam::detail
