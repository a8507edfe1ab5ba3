#pragma once

#include <vector>

#include "isotherm/network/range_network.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::network::detail {

/// A network with one range, the median, between the same two nodes.
struct MergedNetwork {
  RangeNetwork network;
  std::vector<Index> pair_of;      ///< range of the original -> range of `network`
  std::vector<double> deviations;  ///< of each range of the original from its pair's
  std::vector<double> spreads;     ///< one a pair: standard deviation, by the median one
};

/// The ranges must be valid. Of an even number the lower middle one is taken, since
/// ranges that are wrong for want of sight are too long. The variance is the median too:
/// what repeats have in common does not average out. O(ranges log ranges).
MergedNetwork merge_repeats(const RangeNetwork& network);

/// Verdicts on the ranges of the original: those of their pairs, but a range is pruned
/// where it deviates from its pair's by more than sqrt(gate) times the spread of the pair
/// or, if that is larger, its entry in `sigmas`, one a pair.
spectral::EdgeVerdicts verdicts_on_repeats(const RangeNetwork& original,
                                           const MergedNetwork& merged,
                                           const spectral::EdgeVerdicts& pairs,
                                           const std::vector<double>& sigmas, double gate);

}  // namespace isotherm::network::detail
