#pragma once

#include <span>
#include <vector>

#include "isotherm/base/progress.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace isotherm::spectral::detail {

struct WalkAffinityOptions {
  double scale = 1.0;  ///< diffusion time in expected steps of a walk, > 0
  int horizon = 4;     ///< longest walk, in steps, >= 1
  int threads = 0;
  ProgressCallback progress = {};
};

/// The affinities of the edges and of further pairs of a graph.
struct WalkAffinities {
  std::vector<double> edges;  ///< by edge id, each without that edge; in [0, 1]
  std::vector<double> pairs;
};

/// Affinities h_ij / sqrt(h_ii h_jj) in the heat kernel of the normalised graph,
/// exp(t (S - I)) with S = D^-1/2 W D^-1/2, of which walks of up to `horizon` steps
/// are taken: sum_k t^k / k! S^k.
///
/// W has the edges' weights times `trust` (in [0, 1], one an edge). An edge's own
/// affinity is exactly that of S with the edge's entries taken out, D kept: heat that
/// would cross it is lost. 0 where there is no walk, 1 for a self-loop.
///
/// What the horizon K leaves out of an entry of the kernel is at most the Poisson tail
/// P(X > K), X ~ Poisson(t), since the norm of S is 1.
///
/// For each vertex, the powers of S on the ball of horizon - 1 steps: time n times the
/// edges in that ball, memory horizon * (n + m + pairs) numbers.
/// @throws Cancelled
WalkAffinities walk_affinities(const WeightedGraph& graph, std::span<const double> trust,
                               std::span<const VertexPair> pairs,
                               const WalkAffinityOptions& options);

/// The largest horizon, at most `wanted` and at least 2, with which walk_affinities
/// costs no more than about `budget` steps along edges, estimated from a few vertices.
int affordable_horizon(const WeightedGraph& graph, std::span<const double> trust, int wanted,
                       double budget);

}  // namespace isotherm::spectral::detail
