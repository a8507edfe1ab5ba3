#pragma once

#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

/// What constraints leave free: one rigid motion per connected component, so one
/// pose of each is held.
struct Gauge {
  std::vector<Index> component;  ///< per vertex, numbered by smallest vertex
  Index component_count = 0;
  std::vector<Index> held;      ///< vertices that do not move, ascending
  std::vector<Index> variable;  ///< per vertex: its number among the free ones, or -1
  Index variable_count = 0;
};

/// Components are those of the constraints whose information is not zero (self
/// loops join nothing). In each one the vertices the graph fixes are held, or
/// else its first vertex. O(n + m).
template <class Pose>
Gauge fix_gauge(const PoseGraph<Pose>& graph);

}  // namespace isotherm::slam::detail
