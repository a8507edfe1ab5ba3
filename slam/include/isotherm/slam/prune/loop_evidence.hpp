#pragma once

#include <vector>

#include "isotherm/slam/prune/consensus.hpp"

namespace isotherm::slam {

/// The log evidence (nats, up to a constant of the graph) that certain loops are the true ones and
/// no others, at the scales that are learnt from them: that of which consensus() looks for the
/// highest. So answers of any methods can be compared. `edges` are the positions among the graph's
/// constraints of the loops; candidates that repeat another one or join a vertex with itself are
/// left out.
/// @throws InvalidArgument for edges that are no candidates, NumericalError, Cancelled
template <class Pose>
double loop_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const std::vector<Index>& edges, const ConsensusOptions& options = {},
                     const RunContext& run = {});

}  // namespace isotherm::slam
