#pragma once

#include <cstdint>
#include <vector>

#include "distributed/graph/graph_state.hpp"
#include "distributed/support/steps.hpp"
#include "heat/heat_bracket.hpp"

namespace isotherm::spectral::distributed::detail {

/// A pair of rows, the first of which is this rank's, with what is known of it.
struct HeatQuery {
  VertexPair rows;
  std::vector<CertifiedValue> values;  // one a scale
  std::int32_t steps = 0;
};

/// Answers queries within what their pairs can reach: the rows within some steps of them are
/// brought to this rank, in more and more steps, and Lanczos runs there as on one machine. Gives
/// the places of queries that would need more rows than the ranks have on average.
std::vector<std::size_t> answer_nearby(const Graph::State& graph,
                                       const spectral::detail::HeatGoal& goal, const Steps& steps,
                                       std::vector<HeatQuery>& queries);

/// Answers those of `queries` that `which` names by Lanczos over all ranks, several at once.
void answer_everywhere(const Graph::State& graph, const spectral::detail::HeatGoal& goal,
                       const Steps& steps, const std::vector<std::size_t>& which,
                       std::vector<HeatQuery>& queries);

}  // namespace isotherm::spectral::distributed::detail
