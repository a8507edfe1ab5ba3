#pragma once

#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// The constraints in an order in which a robot can have measured them: each one after the steps
/// that lead to its ends, loops of one pose in the order they had. Time is told by ids, without the
/// letter of the robot.
template <class Pose>
std::vector<Index> replay_order(const PoseGraph<Pose>& graph);

/// The graph with its constraints in that order.
template <class Pose>
PoseGraph<Pose> in_replay_order(PoseGraph<Pose> graph);

}  // namespace isotherm::slam
