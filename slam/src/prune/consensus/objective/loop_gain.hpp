#pragma once

#include "prune/consensus/estimate/belief.hpp"
#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/objective/error_scales.hpp"

namespace isotherm::slam::detail {

/// What odometry and the other accepted loops say of a loop's residual, along axes in which both
/// that and the error of the loop's own measurement are independent, in units of the latter's
/// deviation as learnt or stated.
template <class Pose>
struct Prediction {
  typename Pose::Tangent r;         ///< the residual
  typename Pose::Tangent variance;  ///< that they leave it, without the loop's own error
  double log_sigma = 0.0;           ///< log |Sigma|, of that error
};

/// What is believed without a loop, by what is with it, whose mean information is Omega.
template <class Pose>
Belief<Pose> without(const Belief<Pose>& with, const typename Pose::Matrix& Omega);

/// The residual with a loop of that mean information, by what is believed without it.
template <class Pose>
typename Pose::Tangent residual_with(const Belief<Pose>& others,
                                     const typename Pose::Matrix& Omega);

/// `others`: without the loop.
template <class Pose>
Prediction<Pose> predict(const Belief<Pose>& others, const typename Pose::Matrix& Sigma);

/// What a loop adds to the log evidence.
struct LoopGain {
  double log_density = 0.0;  ///< log p(z | the others)
  double chi2 = 0.0;         ///< r' (scale Sigma + P)^-1 r at the scale of most
  LoopWeight weight;         ///< see ErrorScale
};

/// The covariance of a loop's error but for its scale.
template <class Pose>
struct OwnError {
  const typename Pose::Matrix& learnt;  ///< with the factors on coordinates
  const typename Pose::Matrix& stated;
};

/// Integrates over the factors on covariances, whose logs are known to within `deviation`: what
/// others leave to the loop grows with that of odometry.
template <class Pose>
LoopGain loop_gain(const Belief<Pose>& others, const OwnError<Pose>& own,
                   const ScaleMixture& mixture, const CovarianceScale& deviation = {0.0, 0.0});

}  // namespace isotherm::slam::detail
