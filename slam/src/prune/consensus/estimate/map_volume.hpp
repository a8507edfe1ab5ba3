#pragma once

#include <vector>

#include <Eigen/Cholesky>

#include "isotherm/slam/graph/pose.hpp"

namespace isotherm::slam::detail {

/// "Anywhere": the distribution that a false loop's residual is taken to have.
///
/// A normal density whose covariance M is isotropic in translation and in
/// rotation, with |2 pi M|^(1/2) the volume that relative poses can take on the
/// map: twice its extent a direction, and every rotation.
template <class Pose>
class MapVolume {
 public:
  using Matrix = typename Pose::Matrix;
  using Tangent = typename Pose::Tangent;

  explicit MapVolume(const std::vector<Pose>& poses);

  const Tangent& variance() const noexcept { return variance_; }

 private:
  Tangent variance_;
};

/// How a loop's residual r compares with a prediction of covariance S.
struct Evidence {
  double chi2 = 0.0;  ///< r' S^-1 r
  /// Log density of r under the prediction, limited to the map, relative to
  /// anywhere: -chi2/2 + log(|S + M| / |S|)/2. Tends to -chi2/2 for a prediction
  /// that says nothing.
  double log_ratio = 0.0;
};

template <class Pose>
Evidence weigh(const typename Pose::Tangent& r, const typename Pose::Matrix& S,
               const MapVolume<Pose>& map);

}  // namespace isotherm::slam::detail
