#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/estimate/map_volume.hpp"

namespace isotherm::slam::detail {

/// What the data say about the covariances that the file states.
///
/// Odometry's may be widened, or tightened as far as short cycles of loops and odometry
/// vouch for. Those see no slow drift: room is left for it, most of it only once the
/// loops that do without have been accepted. Loops' are tightened only as far as the tail
/// of the accepted ones lets the correct ones stay: real errors have heavy tails.
template <class Pose>
class Calibration {
 public:
  using Pairs = std::vector<std::pair<Index, Index>>;

  /// `pairs` (near_pairs) are the short cycles. Both must outlive this object. Unless
  /// `may_widen`, covariances are only tightened.
  Calibration(const ReducedGraph<Pose>& graph, const Pairs& pairs, bool may_widen)
      : graph_(graph), pairs_(pairs), most_(may_widen ? kNoLimit : 1.0) {}

  /// The factors on what the file states.
  CovarianceScale scale() const { return {scale_.odometry, scale_.loops * tightened_}; }

  /// Whether short cycles show the errors to be smaller than the file states.
  bool overstated() const noexcept { return least_odometry_ < 1.0; }

  /// Mean chi-squared a degree of freedom of the accepted loops where their covariances
  /// are only widened, as last learnt; 1 before. Below 1 where the file understates how
  /// accurate they are.
  double loop_level() const noexcept { return loop_level_; }

  /// Odometry's covariance from the short cycles of all loops, true and false. Comes
  /// before learn_from_accepted().
  void learn_from_cycles(const MapVolume<Pose>& map);

  /// One step of variance components from the accepted loops. `tail_share` is how far out
  /// their errors reach, as a share of what the scale allows. True if the scale or the
  /// level has changed so much that loops should be judged again.
  bool learn_from_accepted(const Estimate<Pose>& estimate, const std::vector<bool>& accepted,
                           const std::vector<double>& probability, double tail_share);

  /// Whether the accepted loops want covariances wider than the file states.
  bool asks_for_wider(const Estimate<Pose>& estimate, const std::vector<bool>& accepted,
                      const std::vector<double>& probability) const;

  /// Doubles odometry's covariance, as far as short cycles permit.
  void double_odometry();

  /// Leaves more room for drift from here on. False if that changes nothing, odometry
  /// being as accurate as stated or less.
  bool allow_for_drift();

 private:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  // The scale, but with loops as accurate as short cycles show, which go through them as
  // well: most are, if not the worst.
  CovarianceScale shown() const {
    return {scale_.odometry, scale_.loops * std::min(tightened_, least_odometry_)};
  }

  // By variance components.
  CovarianceScale wanted(const Estimate<Pose>& estimate, const std::vector<bool>& accepted,
                         const std::vector<double>& probability) const;
  double margin() const;
  double most_odometry() const;
  double least_odometry(const std::vector<double>& chi2) const;

  const ReducedGraph<Pose>& graph_;
  const Pairs& pairs_;
  double most_;                     // of both scales
  std::vector<double> cycle_chi2_;  // one a pair, at the covariances of the file
  CovarianceScale scale_;           // variance components; of loops at least 1
  bool drift_allowed_ = false;
  double least_odometry_ = 1.0;
  double loop_level_ = 1.0;
  double tightened_ = 1.0;  // loops' covariances on top of that; at most 1
};

extern template class Calibration<Pose2>;
extern template class Calibration<Pose3>;

}  // namespace isotherm::slam::detail
