#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "prune/consensus/climb/assessment.hpp"

namespace isotherm::slam::detail {

/// Where a climb goes on from: an explanation, and what was found with it.
template <class Pose>
struct Standpoint {
  Explanation<Pose> explanation;
  typename Assessment<Pose>::Findings found;
};

/// Which of the loops and of the vertices that were known before each one is; none where new.
struct KnownBefore {
  std::vector<std::optional<Index>> loops;
  std::function<std::optional<Index>(Index)> vertex;
};

/// What explained some of the loops, for all of `objective`: new ones are not accepted; scales and
/// weights are those that were learnt, and as large a share of all is of each. Vertices that lay on
/// no map follow odometry. The density of near pairs is to be found anew.
template <class Pose>
Standpoint<Pose> carry(const Explanation<Pose>& before,
                       const typename Assessment<Pose>::Findings& found,
                       const Objective<Pose>& objective, const KnownBefore& known);

}  // namespace isotherm::slam::detail
