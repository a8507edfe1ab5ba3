#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "prune/consensus/objective/runs.hpp"
#include "prune/consensus/objective/standing.hpp"

namespace isotherm::slam::detail {

/// Loops that are accepted together, and by how much that raises the evidence.
struct Group {
  std::vector<Index> loops;       ///< ascending
  double gain = 0.0;              ///< evidence, and the log odds of any loop being true
  std::pair<Index, Index> parts;  ///< of the map that its first loop joins
};

/// The `open` loops in groups of those that the loop before in their run predicts better than
/// chance does (its log density in `run_density`, that of chance from `alternative`). Of a group
/// the member that the map predicts best comes first; each other one counts by what predicts it
/// better, the map or the loop before.
template <class Pose>
std::vector<Group> groups_of(const Runs<Pose>& runs, const std::vector<bool>& open,
                             const std::vector<Standing>& standings,
                             const std::vector<double>& run_density,
                             const std::function<double(Index)>& alternative);

/// The groups that gain most as one, as many as are likely all true and not many more than
/// `accepted`, those in force; of groups that nothing connects to the map those that join
/// parts that no better one joins already.
Group most_certain(std::vector<Group> groups, std::size_t accepted);

}  // namespace isotherm::slam::detail
