#pragma once

#include <vector>

#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// A graph in which each chain of edges through vertices of degree two is one edge.
struct SeriesReduction {
  WeightedGraph graph;          ///< on the same vertices
  std::vector<Index> chains;    ///< by original edge: the edge it is part of, or kNone
  std::vector<double> lengths;  ///< by edge of `graph`: how many original edges are part of it

  static constexpr Index kNone = -1;
};

/// Leaves out the edges that `left_out` marks and self-loops, then replaces each
/// longest chain of edges, whose inner vertices have no other edge, by one edge between
/// its ends, with the harmonic mean of their weights. Chains that close on themselves
/// are left out too. O(n + m).
SeriesReduction reduce_series(const WeightedGraph& graph, const std::vector<bool>& left_out);

}  // namespace isotherm::spectral::detail
