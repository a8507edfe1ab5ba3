#pragma once

#include <vector>

#include "localize/problem/absence.hpp"
#include "localize/problem/patch.hpp"
#include "localize/problem/range_problem.hpp"
#include "localize/problem/small_network.hpp"

namespace isotherm::network::detail {

/// What speaks for and against places, as learned from maps.
struct Evidence {
  Absence absence;  ///< of ranges
  Limits limits;    ///< what ranges that do not fit cost
};

/// From the trusted pairs of placed nodes. A range that does not fit costs twice the log of how
/// much likelier a range that fits is a correct one than one of any length; that is
/// learned for ranges that are too long and too short apart: without line of sight they are
/// only ever too long, and between the wrong nodes mostly too short.
Evidence learn_evidence(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                        const Placement& placement);

/// The same from local maps.
Evidence learn_evidence(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                        const std::vector<Patch>& patches);

}  // namespace isotherm::network::detail
