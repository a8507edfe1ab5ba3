#pragma once

#include <utility>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

/// The same measurement told from the other end: its residuals are those of the constraint,
/// mapped by the adjoint.
template <class Pose>
Constraint<Pose> reversed(const Constraint<Pose>& constraint) {
  Constraint<Pose> other = constraint;
  std::swap(other.from, other.to);
  other.T_from_to = constraint.T_from_to.inverse();
  const typename Pose::Matrix adjoint = other.T_from_to.adjoint();
  other.information = adjoint.transpose() * constraint.information * adjoint;
  return other;
}

}  // namespace isotherm::slam::detail
