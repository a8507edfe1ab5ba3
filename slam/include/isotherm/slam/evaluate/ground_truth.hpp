#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/graph/trajectory.hpp"

namespace isotherm::slam {

/// Where ground truth comes from and how it is matched to vertices.
struct GroundTruthSource {
  /// A pose graph (g2o or TORO, matched by vertex id), or a trajectory in any
  /// format that read_trajectory knows.
  std::string path;
  /// One time in seconds a line, line k being vertex k: a trajectory with times is
  /// then interpolated at them. Without it, pose k belongs to vertex k.
  std::string timestamps;
  /// Seconds to the nearest ground-truth sample beyond which a vertex has no ground
  /// truth; 0: no limit.
  double max_gap = 0.0;
  /// Which way the axes of poses in space point. Automatic: a camera's where the graph is in
  /// the plane and the truth in KITTI's format, else those of the graph.
  Axes axes = Axes::automatic;
  bool partial = false;  ///< accept a truth of fewer than half of the vertices
};

/// The ground-truth pose of every vertex, or nothing where there is none.
///
/// Between samples translation is interpolated linearly and rotation along the
/// shorter arc; before the first and after the last sample the nearest one holds.
/// A camera's poses are turned to a vehicle's axes. For a graph in the plane, poses in space
/// are seen from above, along z. Planar ground truth of a graph in space is lifted to z = 0.
/// @throws FileError, ParseError; InvalidArgument if times are needed and absent, or
///   given for a pose graph, a trajectory without times has another length than the graph, or fewer
///   than half of the vertices have a true pose and that is not accepted
template <class Pose>
std::vector<std::optional<Pose>> read_ground_truth(const PoseGraph<Pose>& graph,
                                                   const GroundTruthSource& source);

/// How many of `truth` are known.
template <class Pose>
std::size_t count_known(const std::vector<std::optional<Pose>>& truth) {
  return static_cast<std::size_t>(
      std::count_if(truth.begin(), truth.end(), [](const auto& pose) { return pose.has_value(); }));
}

}  // namespace isotherm::slam
