#pragma once

#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// A constraint that says again, to the last digit, what another one says.
struct Repeat {
  Index edge = 0;      ///< positions of constraints
  Index original = 0;  ///< the first that says it; smaller than `edge`
};

/// Constraints with the ends, the transform and the information of an earlier one, bit by
/// bit, or with those of its inverse where inverting leaves no rounding: one measurement
/// that was written down twice. In order of `edge`. Edges from a vertex to itself are left
/// out. O(m log m).
template <class Pose>
std::vector<Repeat> exact_repeats(const PoseGraph<Pose>& graph);

}  // namespace isotherm::slam
