#include "isotherm/network/localize/anchor_conflicts.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace isotherm::network {
namespace {

using spectral::Verdict;

// How the ranges between two nodes with a position were judged.
struct PairVerdicts {
  Index kept = 0;
  Index pruned = 0;
};

std::map<std::pair<Index, Index>, PairVerdicts> verdicts_by_pair(const RangeNetwork& network,
                                                                 const LocalizeResult& result) {
  const auto placed = [&](Index v) {
    return result.nodes[v] == NodeStatus::anchor || result.nodes[v] == NodeStatus::localised;
  };
  std::map<std::pair<Index, Index>, PairVerdicts> pairs;
  for (std::size_t k = 0; k < network.ranges.size(); ++k) {
    const auto& range = network.ranges[k];
    if (!placed(range.from) || !placed(range.to)) continue;
    auto& pair = pairs[std::minmax(range.from, range.to)];
    if (result.verdicts[k].verdict == Verdict::keep) ++pair.kept;
    if (result.verdicts[k].verdict == Verdict::prune) ++pair.pruned;
  }
  return pairs;
}

}  // namespace

std::vector<AnchorConflict> anchor_conflicts(const RangeNetwork& network,
                                             const LocalizeResult& result) {
  std::map<Index, AnchorConflict> of;
  for (const auto& [ends, pair] : verdicts_by_pair(network, result)) {
    for (const Index end : {ends.first, ends.second}) {
      if (result.nodes[end] != NodeStatus::anchor) continue;
      auto& conflict = of[end];
      conflict.anchor = end;
      ++conflict.ranges;
      if (pair.pruned > pair.kept) ++conflict.against;
    }
  }
  std::vector<AnchorConflict> found;
  for (const auto& [anchor, conflict] : of) {
    if (2 * conflict.against > conflict.ranges) found.push_back(conflict);
  }
  return found;
}

}  // namespace isotherm::network
