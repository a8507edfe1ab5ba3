#pragma once

#include <cstddef>
#include <vector>

#include "isotherm/slam/prune/consensus.hpp"
#include "prune/consensus/objective/objective.hpp"

namespace isotherm::slam::detail {

/// What the odds of a loop make of it, under an explanation that has `accepted` it or not. Without
/// `refutable` nothing can speak against it.
spectral::Verdict verdict_of(bool accepted, double log_odds, double decisive, bool refutable);

/// Whether so many loops are true that they and odometry can speak against others.
bool can_refute(std::size_t accepted);

/// Where the verdict on a loop comes from: accepted, rejected or unconnected.
const char* stage_of(bool accepted, bool connected);

/// Turns explanations of the same candidates, the best first and each once, into verdicts, of which
/// `result` has one a candidate, and into all else but conflicts and moves.
template <class Pose>
void report(const std::vector<Explanation<Pose>>& found, double significance,
            ConsensusResult& result);

}  // namespace isotherm::slam::detail
