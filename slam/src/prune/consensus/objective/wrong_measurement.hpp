#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "matrices/decompositions.hpp"
#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {

/// Degrees of freedom of the tails of wrong measurements: Cauchy's.
inline constexpr double kWrongDof = 1.0;

/// log of the density of the residual r of a loop of the right place that measures it wrong, where
/// true ones err by `covariance` and the place is known up to `place`. It has its mode where errors
/// are as long as expected of those that err by a deviation more, of the prior of how accurate
/// measurements are (kScaleDeviation: ten times as much), falls beyond as Cauchy's does, and within
/// to nothing: what is not off is no wrong measurement. An inverse moment density (Johnson and
/// Rossell, On the use of non-local prior densities in Bayesian hypothesis tests, 2010, equation
/// 12).
template <class Pose>
double log_wrong(const typename Pose::Tangent& r, const typename Pose::Matrix& covariance,
                 const typename Pose::Matrix& place) {
  constexpr double kHalf = 0.5 * (kWrongDof + Pose::kDof);
  static const double kMode = kHalf * Pose::kDof * std::exp(kScaleDeviation);
  constexpr double kLeast = 1e-9;  // squares; below they are none
  static const double log_constant = std::lgamma(0.5 * Pose::kDof) - std::lgamma(0.5 * kWrongDof) -
                                     0.5 * Pose::kDof * std::log(std::numbers::pi);
  const Eigen::LLT<typename Pose::Matrix> factor(kMode * covariance + place);
  const double square = std::max(r.dot(factor.solve(r)), kLeast);
  return log_constant - 0.5 * log_determinant(factor) - kHalf * std::log(square) - 1.0 / square;
}

}  // namespace isotherm::slam::detail
