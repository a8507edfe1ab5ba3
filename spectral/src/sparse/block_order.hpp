#pragma once

#include <span>
#include <utility>
#include <vector>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

/// Blocks with at most two neighbours, in an order in which they can be eliminated
/// first, and what is left of the graph then.
struct ChainElimination {
  std::vector<Index> order;                    ///< eliminated, in order
  std::vector<Index> core;                     ///< left over, ascending
  std::vector<std::pair<Index, Index>> pairs;  ///< between places in `core`, first < second
};

/// Eliminates what has at most two neighbours, again and again, independent ones
/// together. No fill arises, and a chain becomes a branch of logarithmic height, where
/// minimum degree would leave one as long as the chain. O(size of the graph).
ChainElimination eliminate_chains(Index count, std::span<const std::pair<Index, Index>> pairs);

}  // namespace isotherm::spectral::detail
