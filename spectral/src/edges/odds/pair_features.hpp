#pragma once

#include <span>
#include <vector>

#include "edges/odds/edge_odds.hpp"
#include "isotherm/base/progress.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// One number of every edge and of every pair.
struct Measured {
  std::vector<double> edges;
  std::vector<double> pairs;
};

struct PairFeatureOptions {
  int most_steps = 20;  ///< more steps between two ends say no more
  int threads = 0;
  ProgressCallback progress = {};
};

/// The numbers given, and what the graph says of the ends of each edge, without the edge, and of
/// each pair: the steps from one to the other, the logarithm of how many neighbours they have in
/// common, and the logarithms of how many neighbours each has.
///
/// Only edges with a `trust` above 0 are there. Fewer than three neighbours count as three: graphs
/// are judged without chains and dead ends, so that no pair has fewer, but an edge that is left
/// out may leave two.
/// @throws Cancelled
PairFeatures pair_features(const WeightedGraph& graph, std::span<const double> trust,
                           std::span<const VertexPair> pairs, std::span<const Measured> given,
                           const PairFeatureOptions& options);

}  // namespace isotherm::spectral::detail
