#pragma once

#include <cstddef>
#include <vector>

#include "isotherm/slam/prune/consensus.hpp"
#include "prune/consensus/objective/objective.hpp"

namespace isotherm::slam::detail {

/// All that consensus() gives but conflicts: climbs from several scales to the explanations of
/// the highest evidence, and what they say together of every loop.
template <class Pose>
ConsensusResult judge_by_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                  const ConsensusOptions& options, const RunContext& run);

/// Fewer loops say too little of how accurate odometry is for one of them to be pruned.
inline constexpr std::size_t kFewLoops = 5;

/// What the odds of a loop make of it, under an explanation that has `accepted` it or not. Without
/// `refutable` nothing can speak against it.
spectral::Verdict verdict_of(bool accepted, double log_odds, double decisive, bool refutable);

/// Where the verdict on a loop comes from: accepted, rejected or unconnected.
const char* stage_of(bool accepted, bool connected);

/// Turns explanations of the same candidates, the best first, into verdicts, of which `result` has
/// one a candidate, and into all else but conflicts and moves.
template <class Pose>
void report(const std::vector<Explanation<Pose>>& found, double significance,
            ConsensusResult& result);

/// Whether covariances can be had of odometry and of loops: some matrix of each says something.
template <class Pose>
bool has_information(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

}  // namespace isotherm::slam::detail
