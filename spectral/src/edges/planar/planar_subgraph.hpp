#pragma once

#include <span>
#include <vector>

#include "isotherm/base/progress.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

struct PlanarSubgraphOptions {
  int rounds = 6;              ///< of improvement at most, >= 0
  double budget = 1.7e7;       ///< edges that planarity tests may look at, over all tests
  double least_forced = 0.0;   ///< what is worth less is only taken in where there is room
  double most_left_out = 0.2;  ///< share of the edges; a graph that needs more is not nearly planar
  ProgressCallback progress = {};
};

/// A large planar part of a graph.
struct PlanarSubgraph {
  std::vector<bool> chosen;  ///< by edge; empty where the graph is not nearly planar
  double worth = 0.0;        ///< sum over the chosen edges
  double work = 0.0;         ///< edges that planarity tests have looked at
};

/// Whether a planar part that leaves out no more than options.most_left_out of the edges may exist:
/// it has up to three edges a vertex (Euler). O(n + m).
bool has_few_enough_edges(const WeightedGraph& graph, const PlanarSubgraphOptions& options = {});

/// Edges of a nearly planar graph that can be drawn without crossings and to which no other can be
/// added, of as great a worth as a local search finds: to find the greatest is NP-hard
/// (P. Liu and R. Geldmacher 1979).
///
/// Edges are taken in order of suspicion, the least suspicious first, as far as they fit. Then, in
/// rounds, an edge left out is forced in, and those around what it crosses are taken out and
/// put in again as far as they fit; and those of the more suspicious half of the chosen edges
/// that others would cross are taken out to see what fits in their place. A change stays
/// if it raises the worth, or leaves it and lowers the suspicion. Each step is a few planarity
/// tests, so that time is about quadratic in the edges. Where the budget does not last for the
/// first pass, nothing is chosen; self-loops never are.
/// @param worth one an edge, > 0
/// @param suspicion one an edge
/// @throws Cancelled
PlanarSubgraph find_planar_subgraph(const WeightedGraph& graph, std::span<const double> worth,
                                    std::span<const double> suspicion,
                                    const PlanarSubgraphOptions& options = {});

}  // namespace isotherm::spectral::detail
