#pragma once

#include <limits>
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
struct Use {
  enum class As { none, step, loop } as = As::none;
  /// Of its residual: beyond, it is left out (truncated least squares).
  double most_chi2 = std::numeric_limits<double>::infinity();
};

/// Moves the poses of `graph`, which lie near, to where its constraints, one entry of `uses` each,
/// fit best. Where that cannot be found they stay.
template <class Pose>
void settle_poses(PoseGraph<Pose>& graph, const std::vector<Use>& uses,
                  const Accuracy<Pose>& accuracy);

}  // namespace isotherm::slam::detail
