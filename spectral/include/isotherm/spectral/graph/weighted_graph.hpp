#pragma once

#include <span>
#include <vector>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral {

/// An undirected edge. The order of the ends carries no meaning for the graph
/// but is kept as given.
struct WeightedEdge {
  Index from = 0;
  Index to = 0;
  double weight = 1.0;  ///< affinity, finite and > 0
};

/// One entry of an adjacency list.
struct Neighbour {
  Index vertex = 0;
  Index edge = 0;  ///< id of the edge that leads there
};

/// An immutable undirected graph with positive edge weights, stored as an edge
/// list plus compressed adjacency.
///
/// Edges keep the ids (positions) they were given in, parallel edges included;
/// a self-loop is allowed and, as in any Laplacian, has no effect there.
class WeightedGraph {
 public:
  WeightedGraph() = default;

  /// O(n + m) time and memory.
  /// @throws InvalidArgument for a negative vertex count, an end outside
  ///   [0, vertex_count), or a weight that is not finite and positive.
  WeightedGraph(Index vertex_count, std::vector<WeightedEdge> edges);

  Index vertex_count() const noexcept { return static_cast<Index>(offsets_.size()) - 1; }
  Index edge_count() const noexcept { return static_cast<Index>(edges_.size()); }

  std::span<const WeightedEdge> edges() const noexcept { return edges_; }
  const WeightedEdge& edge(Index id) const { return edges_[static_cast<std::size_t>(id)]; }

  /// Adjacent vertices in order of edge id; a self-loop appears once.
  std::span<const Neighbour> neighbours(Index vertex) const;

 private:
  std::vector<WeightedEdge> edges_;
  std::vector<Index> offsets_ = {0};   // vertex_count + 1
  std::vector<Neighbour> neighbours_;  // 2 * edge_count, less self-loops
};

/// Which connected component each vertex lies in.
struct ConnectedComponents {
  std::vector<Index> label;  ///< per vertex; numbered by smallest vertex
  Index count = 0;
};

/// O(n + m).
ConnectedComponents connected_components(const WeightedGraph& graph);

/// Sum of the weights of the edges at each vertex; self-loops do not count.
Eigen::VectorXd weighted_degrees(const WeightedGraph& graph);

/// The graph on the same vertices with only the edges whose `keep` entry is
/// true. Edge ids are renumbered in order.
/// @throws InvalidArgument unless `keep` has one entry per edge.
WeightedGraph filter_edges(const WeightedGraph& graph, const std::vector<bool>& keep);

/// The ends of every edge, in order of edge id.
std::vector<VertexPair> edge_pairs(const WeightedGraph& graph);

}  // namespace isotherm::spectral
