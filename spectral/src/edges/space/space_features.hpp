#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edges/odds/pair_features.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// What is thought of the edges of a graph to begin with.
struct FirstGuess {
  std::span<const double> trust;  ///< edges that are likely false have none
  double false_count = 0.0;
};

struct SpaceOptions {
  std::uint64_t seed = 1;
  int threads = 0;
  ProgressCallback progress = {};
};

/// Log odds that a pair is not near, given all other edges and pairs without an edge, where each
/// vertex has a place in space and near ones are joined (contact_graph.hpp).
///
/// Places are sampled several times (place_sampler.hpp), from those that steps along trusted edges
/// suggest (classical_scaling.hpp). A vertex all of whose edges are doubted begins at another of
/// its neighbours in each run, as none is known to be its.
/// @param lengths how many original edges each edge stands for
/// @return log odds, of edges and of pairs in their order, in two and in three dimensions; none for
///   graphs of fewer than ten vertices with an edge, or of more than 1,400, where it would take too
///   long
/// @throws Cancelled
std::vector<Measured> space_features(const WeightedGraph& graph, std::span<const double> lengths,
                                     const FirstGuess& guess, std::span<const VertexPair> pairs,
                                     const SpaceOptions& options);

}  // namespace isotherm::spectral::detail
