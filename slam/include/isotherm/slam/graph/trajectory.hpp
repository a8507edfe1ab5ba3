#pragma once

#include <array>
#include <variant>
#include <vector>

#include "isotherm/base/options.hpp"
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

/// Which way the axes of a body, and those of its world, point.
enum class Axes {
  automatic,  ///< by the format: KITTI's poses are those of a camera
  vehicle,    ///< x forward, y to the left, z up
  camera,     ///< z forward, x to the right, y down
};

constexpr std::array<EnumName<Axes>, 3> enum_names(Axes) {
  return {{{Axes::automatic, "automatic"}, {Axes::vehicle, "vehicle"}, {Axes::camera, "camera"}}};
}

/// The pose of the same body in the same world, both with the other axes.
Pose3 camera_to_vehicle(const Pose3& pose);
Pose3 vehicle_to_camera(const Pose3& pose);

/// A pose whose z is up, as seen from above.
Pose2 flatten(const Pose3& pose);

/// The plane as z = 0 of space; theta becomes the rotation about z.
Pose3 lift(const Pose2& pose);
Trajectory<Pose3> lift(const Trajectory<Pose2>& trajectory);

}  // namespace isotherm::slam
