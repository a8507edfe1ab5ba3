#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "matrices/decompositions.hpp"

namespace isotherm::slam::detail {

inline const double kLog2Pi = std::log(2.0 * std::numbers::pi);

/// log N(r; 0, S), by the factor of S.
template <class Pose>
double log_normal(const typename Pose::Tangent& r,
                  const Eigen::LLT<typename Pose::Matrix>& factor) {
  return -0.5 * (r.dot(factor.solve(r)) + log_determinant(factor) + Pose::kDof * kLog2Pi);
}

template <class Pose>
double log_normal(const typename Pose::Tangent& r, const typename Pose::Matrix& S) {
  return log_normal<Pose>(r, Eigen::LLT<typename Pose::Matrix>(S));
}

/// log of the density that a copied measurement is held against: a normal one's, of this
/// log |Sigma|, at twice the squared length that is expected of its error; no less than that of a
/// draw of its own, by chance.
template <class Pose>
double log_copy_density(double log_sigma, double log_by_chance) {
  return std::max(log_by_chance, -0.5 * (log_sigma + Pose::kDof * kLog2Pi) - Pose::kDof);
}

}  // namespace isotherm::slam::detail
