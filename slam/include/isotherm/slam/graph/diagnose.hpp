#pragma once

#include <string>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// Something about a graph as a whole that is rarely meant, and by which a map can be lost.
struct Doubt {
  std::string kind;     ///< e.g. "swapped ends"
  std::string message;  ///< what was measured, and what it may come from
};

/// What is to be doubted before loops are judged, each by a measurement:
///
/// - "swapped ends", "angles in degrees": loops over short stretches of odometry fit once the
///   measurements are inverted, or their angles multiplied by pi / 180, and do not as they are;
/// - "no odometry", "ids without order", "broken odometry": neighbours in the order of ids
///   that no odometry joins (edge_roles()), while the edges follow each other in the file or do
///   not;
/// - "bridged odometry": where neighbours are not joined, odometry leads past one pose;
/// - "zero information", "identity information", "identical information": what edges state
///   about themselves is nothing, or the same throughout.
///
/// O(m log m), without solving anything.
template <class Pose>
std::vector<Doubt> diagnose(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

}  // namespace isotherm::slam
