#pragma once

#include <utility>
#include <vector>

#include "prune/consensus/climb/assessment.hpp"

namespace isotherm::slam::detail {

/// Loops that are accepted together, and by how much that raises the evidence.
struct Group {
  std::vector<Index> loops;       ///< ascending
  double gain = 0.0;              ///< with the log odds of their labels
  std::pair<Index, Index> parts;  ///< of the map that its first loop joins
};

/// Loops in groups of those that the loop before in their run predicts better than chance does: of
/// `among`, all of which are accepted, or none is. Of a group the member that the map predicts best
/// comes first; each other one counts by what predicts it better, the map or the loop before.
template <class Pose>
std::vector<Group> groups_of(const Assessment<Pose>& assessment, const Explanation<Pose>& now,
                             const std::vector<bool>& among);

/// The groups that gain most as one, as many as are likely all true and not many more than
/// `accepted`, those in force; of groups that nothing connects to the map those that join
/// parts that no better one joins already.
Group most_certain(std::vector<Group> groups, std::size_t accepted);

}  // namespace isotherm::slam::detail
