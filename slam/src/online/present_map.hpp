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

/// What a constraint counts for.
enum class Use {
  none,
  step,
  loop,            ///< judged together with the others
  loop_as_it_came  ///< judged by what was known then: not used where all others contradict it
                   ///< (truncated least squares)
};

/// Moves the poses of `graph`, which lie near, to where its constraints, one entry of `uses` each,
/// fit best. Where that cannot be found they stay.
template <class Pose>
void settle_poses(PoseGraph<Pose>& graph, const std::vector<Use>& uses,
                  const Accuracy<Pose>& accuracy);

}  // namespace isotherm::slam::detail
