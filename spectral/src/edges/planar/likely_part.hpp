#pragma once

#include <span>
#include <vector>

#include "edges/odds/edge_odds.hpp"
#include "edges/odds/pair_features.hpp"
#include "edges/planar/planar_subgraph.hpp"
#include "heat/walk_affinity.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// Log odds that each edge is a true one rather than a false one.
/// @param scores log (f_pairs / f_true) of each edge
/// @param false_count how many are expected to be false
std::vector<double> log_odds_of_true(std::span<const double> scores, double false_count);

/// The log evidence of the mixture (edge_odds.hpp) where an edge outside the planar part is known
/// to be false: such an edge counts by c instead of by (1 - c) f_true / f_pairs + c. What is drawn
/// may be either, as a false edge may happen to cross nothing.
double evidence_of_part(const EdgeOdds& odds, const std::vector<bool>& chosen);

/// How far the ends of edges, each without itself, and of pairs are from each other within a planar
/// part: -log of the affinity of walks, no more than the largest finite one.
Measured distances_within(const WeightedGraph& graph, const std::vector<bool>& chosen,
                          std::span<const VertexPair> pairs, const WalkAffinityOptions& options);

/// The planar part that explains a graph best whose true edges can nearly be drawn without
/// crossings.
///
/// An edge of odds o adds log (1 + o) to the evidence if it is drawn, as it must be false if it is
/// not: so much it is worth in the search for a planar subgraph (planar_subgraph.hpp), and chains
/// of any length hold one false edge at most, so that length is no worth of its own. Odds are those
/// given first, then those of all that is measured within the part found before, until the evidence
/// no longer rises.
/// @param log_odds of true against false, by all that is known without drawing
/// @param pairs that false edges are like
/// @return nothing chosen where the graph is not nearly planar, or too large to find out
/// @throws Cancelled
PlanarSubgraph likely_planar_part(const WeightedGraph& graph, std::span<const double> log_odds,
                                  std::span<const VertexPair> pairs,
                                  const WalkAffinityOptions& options);

}  // namespace isotherm::spectral::detail
