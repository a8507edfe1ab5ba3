#pragma once

#include <string>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// Odometry (constraint numbers) about which nothing can be computed in doubles beside the rest:
/// its information matrix is not is_usable_information(), or, in a direction, further than a factor
/// of 10^11 from what is typical of the graph's odometry. A zero matrix is not among them: it
/// says "not known".
template <class Pose>
std::vector<Index> unusable_information(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

/// The graph with these matrices brought to within a factor of 10^10 of what is typical.
/// @throws NumericalError if an entry is not finite
template <class Pose>
PoseGraph<Pose> with_usable_information(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                        const std::vector<Index>& unusable);

/// What there is to say about them, naming the first by its vertices.
template <class Pose>
std::string describe_unusable(const PoseGraph<Pose>& graph, const std::vector<Index>& unusable);

}  // namespace isotherm::slam
