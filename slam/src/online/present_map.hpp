#pragma once

#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

/// Factors on the stated variances of each coordinate.
template <class Pose>
struct Accuracy {
  typename Pose::Tangent steps = Pose::Tangent::Ones();
  typename Pose::Tangent loops = Pose::Tangent::Ones();
};

/// Moves the poses of `graph`, which lie near, to where its steps and the loops that are `used`,
/// one entry a constraint, fit best. Loops that the others contradict do not count (truncated least
/// squares): each was thought true by what was known when it came. Where that cannot be found they
/// stay.
template <class Pose>
void settle_poses(PoseGraph<Pose>& graph, const std::vector<bool>& is_step,
                  const std::vector<bool>& used, const Accuracy<Pose>& accuracy);

}  // namespace isotherm::slam::detail
