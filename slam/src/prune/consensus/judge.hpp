#pragma once

#include "isotherm/slam/prune/consensus.hpp"

namespace isotherm::slam::detail {

/// All that consensus() gives but conflicts: climbs from several scales to the explanations of
/// the highest evidence, and what they say together of every loop.
template <class Pose>
ConsensusResult judge_by_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                  const ConsensusOptions& options, const RunContext& run);

/// Whether covariances can be had of odometry and of loops: some matrix of each says something.
template <class Pose>
bool has_information(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

}  // namespace isotherm::slam::detail
