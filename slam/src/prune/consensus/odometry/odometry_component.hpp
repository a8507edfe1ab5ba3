#pragma once

#include <span>

#include "prune/consensus/odometry/step_edges.hpp"

namespace isotherm::slam::detail {

/// Odometry as a variance component, by coordinate of its edges (Helmert). Where s_d is the factor
/// on a coordinate's variances, the derivative of the log evidence by log s_d is half of `cost`, in
/// units of the present covariances, less `redundancy`.
template <class Pose>
struct OdometryComponent {
  typename Pose::Tangent cost = Pose::Tangent::Zero();        ///< in units of `scale`
  typename Pose::Tangent redundancy = Pose::Tangent::Zero();  ///< numbers left over
};

/// By the residuals of its steps where the factor on all of odometry's covariances was `scale`.
/// Many edges are contracted into a step, and an early one's error in heading is one in place at
/// the step's end: each edge has the part of the step's error that its own covariance explains.
/// O(edges), on `threads` threads (0: all cores).
template <class Pose>
OdometryComponent<Pose> odometry_component(const ContractedChain<Pose>& odometry, double scale,
                                           std::span<const Belief<Pose>> residuals,
                                           int threads = 1);

}  // namespace isotherm::slam::detail
