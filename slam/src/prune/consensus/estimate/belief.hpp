#pragma once

namespace isotherm::slam::detail {

/// Of a residual, by an estimate.
template <class Pose>
struct Belief {
  typename Pose::Tangent r;
  typename Pose::Matrix P;  ///< its covariance
};

}  // namespace isotherm::slam::detail
