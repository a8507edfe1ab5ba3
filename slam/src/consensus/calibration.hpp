#pragma once

#include <utility>
#include <vector>

#include "estimate.hpp"
#include "map_volume.hpp"

namespace isotherm::slam::detail {

/// What the data say about the covariances that the file states.
///
/// Odometry's may be widened, or tightened as far as short cycles of loops and odometry
/// vouch for; those see no slow drift, so that a margin is left. Loops' are only widened:
/// real ones have heavy tails, and what the file claims of a loop is never tightened.
template <class Pose>
class Calibration {
 public:
  using Pairs = std::vector<std::pair<Index, Index>>;

  /// `pairs` (near_pairs) are the short cycles. Both must outlive this object.
  Calibration(const ReducedGraph<Pose>& graph, const Pairs& pairs) : graph_(graph), pairs_(pairs) {}

  const CovarianceScale& scale() const noexcept { return scale_; }

  /// Mean chi-squared a degree of freedom of the accepted loops at this scale, as last
  /// learnt; 1 before. Below 1 where the file understates how accurate they are.
  double loop_level() const noexcept { return loop_level_; }

  /// Odometry's covariance from the short cycles of all loops, true and false. Comes
  /// before learn_from_accepted().
  void learn_from_cycles(const MapVolume<Pose>& map);

  /// One step of variance components from the accepted loops. True if the scale or the
  /// level has changed so much that loops should be judged again.
  bool learn_from_accepted(const Estimate<Pose>& estimate, const std::vector<bool>& accepted,
                           const std::vector<double>& probability);

  void double_odometry() { scale_.odometry *= 2.0; }

 private:
  double least_odometry(const std::vector<double>& chi2) const;

  const ReducedGraph<Pose>& graph_;
  const Pairs& pairs_;
  std::vector<double> cycle_chi2_;  // one a pair, at the covariances of the file
  CovarianceScale scale_;
  double least_odometry_ = 1.0;
  double loop_level_ = 1.0;
};

extern template class Calibration<Pose2>;
extern template class Calibration<Pose3>;

}  // namespace isotherm::slam::detail
