#pragma once

#include <optional>
#include <span>
#include <vector>

#include "heat/walk_affinity.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

struct PlaneScores {
  std::vector<double> edges;  ///< by edge id
  std::vector<double> pairs;
};

/// Scores by what an edge crosses, for graphs that are nearly planar, such as roads:
///
///   score = 2 c - log a,
///
/// c being how many edges of a large planar subgraph (planar_subgraph.hpp) a curve between the
/// ends has to cross, 0 for the subgraph's own edges, and a the walk affinity of the ends
/// within the subgraph, but no less than the least that is not 0.
///
/// The subgraph is found by the suspicion given, and up to twice again by the affinities within
/// the one before, as long as that is better.
/// @param lengths how many original edges each edge stands for
/// @return nothing where crossings tell little: the graph is not nearly planar, too
///   large to find out, or a fifth of the pairs could be joined without any crossing
/// @throws Cancelled
std::optional<PlaneScores> plane_scores(const WeightedGraph& graph, std::span<const double> lengths,
                                        std::span<const double> suspicion,
                                        std::span<const VertexPair> pairs,
                                        const WalkAffinityOptions& options);

}  // namespace isotherm::spectral::detail
