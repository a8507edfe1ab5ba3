#pragma once

#include "prune/consensus/estimate/estimate.hpp"

namespace isotherm::slam::detail {

/// What odometry and the other accepted loops say of a loop.
template <class Pose>
struct Prediction {
  typename Pose::Tangent r;  ///< the loop's residual there
  typename Pose::Matrix P;   ///< covariance that they leave the residual, without the loop's own
};

/// From an estimate without the loop: `C` is its covariance of T_a^-1 T_b.
template <class Pose>
Prediction<Pose> predict(const typename Pose::Tangent& r, const typename Pose::Matrix& C);

/// From one that includes the loop, with measurement covariance `own`.
template <class Pose>
Prediction<Pose> predict_without(const typename Pose::Tangent& r, const typename Pose::Matrix& C,
                                 const typename Pose::Matrix& own);

/// What a loop adds to the log evidence.
struct LoopGain {
  double log_density = 0.0;  ///< log p(z | the others), Student's tails included
  double chi2 = 0.0;         ///< r' (own + P)^-1 r
};

/// For a loop whose errors are Student's with `nu` degrees of freedom and scale matrix `own`.
/// The posterior is taken as normal around its peak (Laplace).
template <class Pose>
LoopGain loop_gain(const Prediction<Pose>& prediction, const typename Pose::Matrix& own, double nu);

}  // namespace isotherm::slam::detail
