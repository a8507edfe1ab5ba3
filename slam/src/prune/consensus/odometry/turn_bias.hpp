#pragma once

#include <Eigen/Core>

#include "isotherm/slam/graph/pose.hpp"

namespace isotherm::slam::detail {

/// What every step of odometry errs by in the same way: the robot turned by so much more than it
/// tells (rotation vector; rad a step).
template <class Pose>
using TurnBias = Eigen::Matrix<double, Pose::kDof - Pose::kDim, 1>;

/// Of it, the derivative of an error on the right of a motion, or of a residual.
template <class Pose>
using ByBias = Eigen::Matrix<double, Pose::kDof, Pose::kDof - Pose::kDim>;

/// How the robot moved in a step of which odometry tells T.
template <class Pose>
Pose turned(const Pose& T, const TurnBias<Pose>& bias) {
  typename Pose::Tangent turn = Pose::Tangent::Zero();
  turn.template tail<Pose::kDof - Pose::kDim>() = bias;
  return T * Pose::exp(turn);
}

/// Of a motion that a step T follows, from that of the motion before.
template <class Pose>
ByBias<Pose> by_bias_after(const ByBias<Pose>& before, const Pose& T) {
  ByBias<Pose> by = T.inverse().adjoint() * before;
  by.template bottomRows<Pose::kDof - Pose::kDim>().diagonal().array() += 1.0;
  return by;
}

}  // namespace isotherm::slam::detail
