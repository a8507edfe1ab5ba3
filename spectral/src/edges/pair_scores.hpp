#pragma once

#include <limits>
#include <string>
#include <vector>

#include "isotherm/base/run_context.hpp"
#include "isotherm/spectral/edges/judge_edges.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace isotherm::spectral::detail {

/// Scores of edges and of pairs that no edge joins; larger is more suspicious.
struct PairScores {
  std::vector<double> edges;
  std::vector<double> pairs;
  std::vector<std::string> warnings;  ///< what the scores cannot be trusted for
};

/// The score of ends about which nothing is known.
inline constexpr double kUnknownScore = std::numeric_limits<double>::infinity();

/// By jaccard, common neighbours, affinity or resistance, of every edge of a simple graph
/// without itself, and of the pairs; those of a few thousand at most by the last two, for the
/// time they take. Unknown are ends that nothing else joins and ends without other neighbours.
/// @throws InvalidArgument for another method; NumericalError, Cancelled
PairScores score_pairs(const WeightedGraph& graph, const std::vector<VertexPair>& pairs,
                       const JudgeEdgesOptions& options, const RunContext& run);

}  // namespace isotherm::spectral::detail
