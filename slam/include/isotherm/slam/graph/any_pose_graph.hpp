#pragma once

#include <variant>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// A pose graph in the plane or in space.
using AnyPoseGraph = std::variant<PoseGraph<Pose2>, PoseGraph<Pose3>>;

/// The graph as one with poses of this type, which is Pose2 or Pose3.
/// @throws InvalidArgument if its poses are of the other type
template <class Pose>
const PoseGraph<Pose>& as(const AnyPoseGraph& graph);
template <class Pose>
PoseGraph<Pose>& as(AnyPoseGraph& graph);
template <class Pose>
PoseGraph<Pose> as(AnyPoseGraph&& graph);

}  // namespace isotherm::slam
