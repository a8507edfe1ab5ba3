#pragma once

#include <algorithm>
#include <vector>

#include "prune/consensus/constants.hpp"
#include "prune/consensus/estimate/reduced_graph.hpp"

namespace isotherm::slam::detail {

/// A sample of so many loops is of every so many-th stretch at most, so that it is of enough, and
/// of every tenth; below two there is none.
inline std::size_t sampled_at_most(std::size_t loops) {
  return std::min(kBatchGrowth, 1 + loops / (2 * kLeastSample));
}

/// Numbers of the loops, ascending, that were closed in every so many-th stretch of the way:
/// where one lies there, so do others within `window` vertices, so that runs stay together. None
/// where they are too few.
template <class Pose>
std::vector<Index> sample(const ReducedGraph<Pose>& graph, Index window,
                          std::size_t every = kBatchGrowth);

}  // namespace isotherm::slam::detail
