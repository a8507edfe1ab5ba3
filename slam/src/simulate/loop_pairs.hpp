#pragma once

#include <vector>

#include <Eigen/Core>

#include "isotherm/base/random.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

struct LoopPair {
  Index from = 0;
  Index to = 0;
};

/// Up to `wanted` random distinct pairs of places within `radius` of each other but
/// at least ten steps apart along the path, the earlier one first, in order of the
/// later one. Expected O(places + wanted) where places are not crowded.
std::vector<LoopPair> loop_pairs(const std::vector<Eigen::Vector3d>& places, std::int64_t wanted,
                                 double radius, Random& random);

}  // namespace isotherm::slam::detail
