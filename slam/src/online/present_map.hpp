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

/// How loops were judged.
enum class Judged {
  when_they_came,  ///< by what was known then: those that the others contradict do not count
                   ///< (truncated least squares)
  together,        ///< all count
};

/// Moves the poses of `graph`, which lie near, to where its steps and the loops that are `used`,
/// one entry a constraint, fit best. Where that cannot be found they stay.
template <class Pose>
void settle_poses(PoseGraph<Pose>& graph, const std::vector<bool>& is_step,
                  const std::vector<bool>& used, const Accuracy<Pose>& accuracy, Judged judged);

}  // namespace isotherm::slam::detail
