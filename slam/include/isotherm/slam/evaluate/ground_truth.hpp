#pragma once

#include <optional>
#include <string>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

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
};

/// The ground-truth pose of every vertex, or nothing where there is none.
///
/// Between samples translation is interpolated linearly and rotation along the
/// shorter arc; before the first and after the last sample the nearest one holds.
/// For a graph in the plane, poses in space are seen from above: KITTI's camera
/// poses along the camera's y (x is the camera's z, y its -x), others along z.
/// Planar ground truth of a graph in space is lifted to z = 0.
/// @throws FileError, ParseError; InvalidArgument if times are needed and absent,
///   or given for a pose graph, or a trajectory without times has another length than the graph
template <class Pose>
std::vector<std::optional<Pose>> read_ground_truth(const PoseGraph<Pose>& graph,
                                                   const GroundTruthSource& source);

}  // namespace isotherm::slam
