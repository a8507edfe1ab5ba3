#pragma once

#include <vector>

#include "isotherm/slam/graph/range_graph.hpp"

namespace isotherm::slam::detail {

/// How poses hang on each other by steps.
template <class Pose>
struct StepForest {
  struct Link {
    Index parent = -1;  ///< none for the first of a tree
    Pose T_parent_child;
  };
  std::vector<Link> links;   ///< one a node
  std::vector<Index> order;  ///< all nodes, parents first
  /// One a node: when a pose was, in seconds where all poses have a time stamp, else in the order
  /// of the file; of points, before everything.
  std::vector<double> rank;
};

/// Trees grown in breadth from the first pose of each part.
template <class Pose>
StepForest<Pose> step_forest(const RangeGraph<Pose>& graph);

}  // namespace isotherm::slam::detail
