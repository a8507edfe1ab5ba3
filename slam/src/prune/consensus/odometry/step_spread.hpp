#pragma once

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

/// How much the steps of odometry vary from one to the next, in times of what the file says that
/// they err by: the mean square, of all translations and of all turns, each summed over its
/// coordinates. What a sensor tells of a step is how the robot moved and an error that knows
/// nothing of it, so that steps vary as errors do at least (classical errors, as in Carroll,
/// Ruppert, Stefanski and Crainiceanu, Measurement Error in Nonlinear Models, 2006, 1.1).
struct StepSpread {
  double translation = 0.0;  ///< 0 where nothing tells
  double rotation = 0.0;
};

/// `graph`: as in_own_frames() has it. O(odometry).
template <class Pose>
StepSpread step_spread(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

}  // namespace isotherm::slam::detail
