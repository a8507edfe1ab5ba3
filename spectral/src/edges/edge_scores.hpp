#pragma once

#include <limits>
#include <string>
#include <vector>

#include "isotherm/base/run_context.hpp"
#include "isotherm/spectral/edges/judge_edges.hpp"

namespace isotherm::spectral::detail {

/// Scores of edges; larger is more suspicious.
struct EdgeScores {
  std::vector<double> scores;
  std::vector<std::string> warnings;  ///< what the scores cannot be trusted for
};

/// The score of ends about which nothing is known.
inline constexpr double kUnknownScore = std::numeric_limits<double>::infinity();

/// By jaccard, common neighbours, affinity or resistance, of every edge of a simple graph
/// without itself. Unknown are ends that nothing else joins and ends without other neighbours.
/// @throws InvalidArgument for another method; NumericalError, Cancelled
EdgeScores score_edges(const WeightedGraph& graph, const JudgeEdgesOptions& options,
                       const RunContext& run);

}  // namespace isotherm::spectral::detail
