#pragma once

#include <vector>

#include "localize/evidence/evidence.hpp"

namespace isotherm::network::detail {

/// Moves of single nodes `among` all by which the map becomes likelier: those with a range beyond
/// the gate, or beside others without a range to them, go to where their neighbours agree on
/// better; those without a place get one if more than d ranges agree on it. Which moved.
std::vector<Index> relocate(const MapTask& task, const Evidence& evidence,
                            const std::vector<bool>& among, Placement& placement);

}  // namespace isotherm::network::detail
