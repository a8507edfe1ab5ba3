#include "isotherm/slam/graph/trajectory.hpp"

#include <cmath>

#include "isotherm/slam/graph/odometry.hpp"

namespace isotherm::slam {

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
