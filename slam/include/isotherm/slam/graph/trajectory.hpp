#pragma once

#include <variant>
#include <vector>

#include "isotherm/slam/graph/pose.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// Poses over time. A plain value.
template <class Pose>
struct Trajectory {
  std::vector<Pose> poses;         ///< T_world_body
  std::vector<double> timestamps;  ///< seconds, one a pose; or empty if not known
};

/// A trajectory in the plane or in space.
using AnyTrajectory = std::variant<Trajectory<Pose2>, Trajectory<Pose3>>;

/// The vertices of a graph in order of id, without time stamps: its poses, or,
/// where it has none, the chain of its odometry.
template <class Pose>
Trajectory<Pose> trajectory_of(const PoseGraph<Pose>& graph);

/// The plane as z = 0 of space; theta becomes the rotation about z.
Pose3 lift(const Pose2& pose);
Trajectory<Pose3> lift(const Trajectory<Pose2>& trajectory);

}  // namespace isotherm::slam
