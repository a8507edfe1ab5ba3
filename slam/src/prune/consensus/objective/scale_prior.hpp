#pragma once

#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {

// How much more or less accurate measurements are than their file states: with even odds by one
// factor on all variances, or by one on that of each coordinate, whose log is the sum of two
// normal ones around zero, one of all coordinates and one of each, of kScaleDeviation.

/// Of the log of any factor, either way. Beyond, double precision has no digits left for the rest
/// of the graph.
inline constexpr double kMostScale = 4.0 * kScaleDeviation;

/// Deviation of the log of a factor of all coordinates that measurements of this redundancy tell.
inline double scale_deviation(double redundancy) {
  return 1.0 / std::sqrt(0.5 * redundancy + 1.0 / (kScaleDeviation * kScaleDeviation));
}

/// Logs of the factors on the variances of coordinates, `scale` times those of `shape`.
template <class Tangent>
Tangent log_scales(double scale, const Tangent& shape) {
  return std::log(scale) + shape.array().log();
}

/// The other way round.
template <class Tangent>
std::pair<double, Tangent> scale_and_shape(const Tangent& logs) {
  return {std::exp(logs.mean()), (logs.array() - logs.mean()).exp()};
}

/// log of how much likelier as many steps would be that vary as much as errors of these factors do
/// than those are that vary by `most`, less in some coordinates: normal, and of what else varies
/// them nothing is known.
template <class Tangent>
double log_excess(const Tangent& logs, const Tangent& most, double steps) {
  const auto over = (logs - most).array().max(0.0);
  return 0.5 * steps * (over - 1.0 + (-over).exp()).sum();
}

/// Of the logs, with one for each coordinate: (s^2 (I + 11'))^-1 = (I - 11' / (1 + d)) / s^2.
template <class Tangent>
auto prior_precision() {
  constexpr int kSize = Tangent::SizeAtCompileTime;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  const Matrix shared = Matrix::Constant(1.0 / (1.0 + kSize));
  return Matrix((Matrix::Identity() - shared) / (kScaleDeviation * kScaleDeviation));
}

/// log of the prior's density at these, times the width of the posterior's peak, where measurements
/// of this redundancy tell: their likelihood has curvature redundancy / 2 (Laplace).
template <class Tangent>
double log_scale_peak(const Tangent& logs, const Tangent& redundancy) {
  constexpr double kSame = 1e-9;
  const double precision = 1.0 / (kScaleDeviation * kScaleDeviation);
  if (logs.maxCoeff() - logs.minCoeff() < kSame) {
    return -0.5 * precision * logs[0] * logs[0] +
           std::log(scale_deviation(redundancy.sum()) / kScaleDeviation);
  }
  const double with_own = 1.0 + static_cast<double>(logs.size());
  const Tangent curvature = 1.0 + 0.5 / precision * redundancy.array();
  return -0.5 * (logs.dot(prior_precision<Tangent>() * logs) + curvature.array().log().sum() +
                 std::log(with_own) + std::log(1.0 - curvature.cwiseInverse().sum() / with_own));
}

}  // namespace isotherm::slam::detail
