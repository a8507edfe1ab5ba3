#include "isotherm/slam/graph/trajectory.hpp"

#include <cmath>

#include "isotherm/slam/graph/odometry.hpp"

namespace isotherm::slam {
namespace {

// Maps coordinates in a camera's axes to those in a vehicle's: x = z, y = -x, z = -y.
Eigen::Quaterniond vehicle_from_camera() {
  Eigen::Matrix3d rotation;
  rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::Quaterniond(rotation);
}

Pose3 with_axes(const Pose3& pose, const Eigen::Quaterniond& change) {
  return {change * pose.translation(),
          (change * pose.rotation() * change.conjugate()).normalized()};
}

}  // namespace

Pose3 camera_to_vehicle(const Pose3& pose) { return with_axes(pose, vehicle_from_camera()); }

Pose3 vehicle_to_camera(const Pose3& pose) {
  return with_axes(pose, vehicle_from_camera().conjugate());
}

Pose2 flatten(const Pose3& pose) {
  const Eigen::Matrix3d r = pose.rotation_matrix();
  const Eigen::Vector3d& t = pose.translation();
  return {t.x(), t.y(), std::atan2(r(1, 0), r(0, 0))};
}

template <class Pose>
Trajectory<Pose> trajectory_of(const PoseGraph<Pose>& graph) {
  return {graph.poses.empty() ? odometry_poses(graph, edge_roles(graph)) : graph.poses, {}};
}

Pose3 lift(const Pose2& pose) {
  const auto& t = pose.translation();
  const double half = 0.5 * pose.angle();
  return {{t.x(), t.y(), 0.0}, {std::cos(half), 0.0, 0.0, std::sin(half)}};
}

Trajectory<Pose3> lift(const Trajectory<Pose2>& trajectory) {
  Trajectory<Pose3> lifted{{}, trajectory.timestamps};
  lifted.poses.reserve(trajectory.poses.size());
  for (const auto& pose : trajectory.poses) lifted.poses.push_back(lift(pose));
  return lifted;
}

template Trajectory<Pose2> trajectory_of(const PoseGraph<Pose2>&);
template Trajectory<Pose3> trajectory_of(const PoseGraph<Pose3>&);

}  // namespace isotherm::slam
