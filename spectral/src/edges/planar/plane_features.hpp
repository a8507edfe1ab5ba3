#pragma once

#include <optional>
#include <span>
#include <vector>

#include "edges/odds/pair_features.hpp"
#include "heat/walk_affinity.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// How edges and pairs lie in a large planar part of a graph.
struct PlaneFeatures {
  /// Edges of that part that a curve between the ends has to cross; 0 for its own edges.
  Measured crossings;
  /// Whether and how often, as far as that tells: crossings beyond the third count no more.
  Measured few_crossings;
  /// -log of the walk affinity of the ends within that part, no more than the largest finite one.
  Measured distances;
};

/// For graphs that are nearly planar, such as roads.
///
/// The planar part is the one that explains the graph best (likely_part.hpp).
/// @param log_odds of true against false, by all that is known without drawing
/// @return nothing where crossings tell little: the graph is not nearly planar, too
///   large to find out, or a fifth of the pairs could be joined without any crossing
/// @throws Cancelled
std::optional<PlaneFeatures> plane_features(const WeightedGraph& graph,
                                            std::span<const double> log_odds,
                                            std::span<const VertexPair> pairs,
                                            const WalkAffinityOptions& options);

}  // namespace isotherm::spectral::detail
