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

/// What is thought of the edges, which vouch for each other by it.
struct EdgeBelief {
  std::span<const double> truth;  ///< probability that an edge is a true one
  std::span<const double> trust;  ///< 0 where no walk may cross it
};

struct PairFeatureOptions {
  int most_steps = 20;  ///< more steps between two ends say no more
  int threads = 0;
  ProgressCallback progress = {};
};

/// The numbers given, and what the graph says of the ends of each edge, without the edge, and of
/// each pair: the steps from one to the other along trusted edges; log ((d + 1) / (n + 1/2)), where
/// n is how many neighbours they have in common and d how many the end has that has fewer of them,
/// and then the other; and log (d + 1) of both. A neighbour counts by the probability that the
/// edges to it are true. Fewer than three neighbours count as three: graphs are judged without
/// chains and dead ends, so that no pair has fewer, but an edge that is left out may leave two.
/// @throws Cancelled
PairFeatures pair_features(const WeightedGraph& graph, const EdgeBelief& belief,
                           std::span<const VertexPair> pairs, std::span<const Measured> given,
                           const PairFeatureOptions& options);

/// Values beyond the middle one of the pairs taken for that: among pairs that are that far from
/// each other hardly any edge is true, so that a regression learns nothing of them there.
void level_off(Measured& measured);

}  // namespace isotherm::spectral::detail
