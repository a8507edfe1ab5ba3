#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "isotherm/base/progress.hpp"
#include "isotherm/spectral/edges/judge_edges.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

struct AnnealedHeatOptions {
  int rounds = 3;       ///< >= 1
  double chance = 0.7;  ///< edges less likely true take no part in the next round
  ControlGroup control = ControlGroup::anywhere;
  bool places = true;  ///< weigh where vertices of small graphs might be
  std::uint64_t seed = 1;
  int threads = 0;
  ProgressCallback progress = {};
};

/// What the last round found out about each edge.
struct AnnealedHeat {
  /// Log odds of false against true from all that is measured (edge_odds.hpp), the least being 0.
  std::vector<double> scores;
  /// Probability that the edge is a true one; 1 for those that are not judged:
  /// bridges, self-loops, and chains that close on themselves.
  std::vector<double> truth;
  double false_count = 0.0;  ///< estimated number of false edges, a chain counted once
  /// Edges that score more are to be pruned (`rejection_threshold`); infinite if there are none.
  double threshold = std::numeric_limits<double>::infinity();
  double scale = 0.0;     ///< of the last round, in expected steps
  int horizon = 0;        ///< of the last round, in steps
  bool in_plane = false;  ///< whether edges were judged by what they cross
};

/// More than -log of any affinity.
inline constexpr double kNoWalk = 1000.0;

/// Judges all edges by the heat that the rest of the graph carries between their ends,
/// and again in the graph weighted by that judgement, at scales that double.
///
/// Parallel edges are judged as one, bridges are left out, and a chain of edges through vertices of
/// degree two is judged as one edge (series_reduction.hpp): each of its edges has the same detour.
/// If the chain is false, one of its k edges is, and nothing says which: each is false with
/// 1 / k of the chain's probability.
///
/// Walk affinities (walk_affinity.hpp) of the edges are compared with those of a
/// control group of pairs of vertices (control_pairs.hpp, two_groups.hpp). The first horizon is
/// three times the median detour around an edge, as far as that is affordable. Last, all that is
/// measured is weighed (pair_features.hpp, edge_odds.hpp): the affinity of the ends, the steps
/// between them, their neighbours, and where the graph is nearly planar what the edge crosses
/// (plane_features.hpp). Of the answers that begin with and without the most suspicious edges, that
/// of the higher evidence is taken.
/// @throws Cancelled
AnnealedHeat anneal_heat(const WeightedGraph& graph, const AnnealedHeatOptions& options);

}  // namespace isotherm::spectral::detail
