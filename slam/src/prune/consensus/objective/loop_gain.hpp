#pragma once

#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/objective/error_scales.hpp"

namespace isotherm::slam::detail {

/// What odometry and the other accepted loops say of a loop's residual, along axes in which both
/// that and the error of the loop's own measurement are independent, in units of the latter's
/// stated deviation.
template <class Pose>
struct Prediction {
  typename Pose::Tangent r;         ///< the residual
  typename Pose::Tangent variance;  ///< that they leave it, without the loop's own error
  double log_sigma = 0.0;           ///< log |Sigma|, of the stated covariance
};

/// From an estimate without the loop: `P` is its covariance of the residual `r`.
template <class Pose>
Prediction<Pose> predict(const typename Pose::Tangent& r, const typename Pose::Matrix& P,
                         const typename Pose::Matrix& Sigma);

/// From one that includes the loop, with its information times `precision`.
template <class Pose>
Prediction<Pose> predict_without(const typename Pose::Tangent& r, const typename Pose::Matrix& P,
                                 const typename Pose::Matrix& Sigma, double precision);

/// What a loop adds to the log evidence.
struct LoopGain {
  double log_density = 0.0;  ///< log p(z | the others)
  double chi2 = 0.0;         ///< r' (scale Sigma + P)^-1 r at the scale of most
  double weight = 1.0;       ///< see ErrorScale
};

/// Integrates over the factors on covariances, whose logs are known to within `deviation`: what
/// others leave to the loop grows with that of odometry.
template <class Pose>
LoopGain loop_gain(const Prediction<Pose>& prediction, const ScaleMixture& mixture,
                   const CovarianceScale& deviation = {0.0, 0.0});

}  // namespace isotherm::slam::detail
