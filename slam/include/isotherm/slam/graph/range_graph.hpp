#pragma once

#include <string>
#include <variant>
#include <vector>

#include "isotherm/network/range_network.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// Where a node is said to be, apart from all measurements between nodes.
template <class Pose>
struct AbsolutePose {
  Index node = 0;
  Pose T_world_node;
  /// Inverse covariance of log(T_world_node^-1 estimate), ordered (translation, rotation); of a
  /// point, nothing about rotation.
  typename Pose::Matrix information = Pose::Matrix::Zero();
};

/// Robots that move among beacons: poses, points, the steps between poses and the distances
/// between any two nodes. A plain value. A point (a beacon, a landmark) is a pose of which the
/// rotation means nothing.
template <class Pose>
struct RangeGraph {
  std::vector<std::string> names;                 ///< one a node, in order of appearance
  std::vector<Pose> positions;                    ///< as the file says, one a node
  std::vector<bool> placed;                       ///< whether the file says
  std::vector<bool> is_point;                     ///< no pose of a robot
  std::vector<double> stamps;                     ///< seconds, one a node; NaN where not known
  std::vector<Constraint<Pose>> steps;            ///< odometry, and loops if there are any
  std::vector<AbsolutePose<Pose>> priors;         ///< in the order of the file
  std::vector<network::RangeMeasurement> ranges;  ///< in the order of the file

  Index node_count() const noexcept { return static_cast<Index>(names.size()); }
};

/// In the plane or in space.
using AnyRangeGraph = std::variant<RangeGraph<Pose2>, RangeGraph<Pose3>>;

}  // namespace isotherm::slam
