#pragma once

#include <vector>

#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// A graph without parallel edges and self-loops.
struct SimpleGraph {
  WeightedGraph graph;        ///< weights of parallel edges added up
  std::vector<Index> merged;  ///< by original edge: its edge here, or kNone for a self-loop

  static constexpr Index kNone = -1;
};

/// O(n + m log m).
SimpleGraph merge_parallel_edges(const WeightedGraph& graph);

}  // namespace isotherm::spectral::detail
