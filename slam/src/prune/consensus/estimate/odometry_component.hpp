#pragma once

#include <optional>
#include <span>
#include <vector>

#include "prune/consensus/estimate/estimate.hpp"

namespace isotherm::slam::detail {

/// Odometry as a variance component, by coordinate of its edges (Helmert). Where s_d is the factor
/// on a coordinate's variances, the derivative of the log evidence by log s_d is half of `cost`, in
/// units of the present covariances, less `redundancy`.
template <class Pose>
struct OdometryComponent {
  typename Pose::Tangent cost = Pose::Tangent::Zero();        ///< in units of `scale`
  typename Pose::Tangent redundancy = Pose::Tangent::Zero();  ///< numbers left over
};

/// One edge of an odometry chain, between a vertex and the next.
template <class Pose>
struct ChainEdge {
  Pose T;                            ///< from the vertex to the next
  bool forward;                      ///< told from the vertex
  typename Pose::Matrix covariance;  ///< where it is told from, as stated
};

/// That of each vertex to the next; empty where there is none.
template <class Pose>
std::vector<std::optional<ChainEdge<Pose>>> chain_of(const PoseGraph<Pose>& graph,
                                                     const EdgeRoles& roles);

/// Of `chain`, as reduced with the factors `shape` on its variances, at the last update of
/// `estimate`, where the factor on all of them was `scale`. Many edges are contracted into a step,
/// and an early one's error in heading is one in place at the step's end: each edge has the part of
/// the step's error that its own covariance explains. `covariances` are those of the steps
/// (Estimate::residual_covariances). O(edges), on `threads` threads (0: all cores).
template <class Pose>
OdometryComponent<Pose> odometry_component(const std::vector<std::optional<ChainEdge<Pose>>>& chain,
                                           const typename Pose::Tangent& shape, double scale,
                                           const ReducedGraph<Pose>& reduced,
                                           const Estimate<Pose>& estimate,
                                           std::span<const typename Pose::Matrix> covariances,
                                           int threads = 1);

}  // namespace isotherm::slam::detail
