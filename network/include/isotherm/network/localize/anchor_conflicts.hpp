#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"

namespace isotherm::network {

/// An anchor whose own ranges speak against the position it was given.
struct AnchorConflict {
  Index anchor = 0;   ///< position in RangeNetwork::names
  Index ranges = 0;   ///< of the anchor to nodes with a position
  Index against = 0;  ///< of these, how many are not as long as the positions say
};

/// The anchors of which more ranges contradict the positions than agree with them: those, more
/// than half of whose ranges to nodes with a position were pruned. Several ranges between the same
/// two nodes count as one. Ascending. O(ranges).
///
/// Where no node has a position, the anchors' own ranges to each other are all there is; where
/// these do not exist, none is found.
std::vector<AnchorConflict> anchor_conflicts(const RangeNetwork& network,
                                             const LocalizeResult& result);

}  // namespace isotherm::network
