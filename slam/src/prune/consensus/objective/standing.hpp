#pragma once

#include <utility>

#include "isotherm/slam/graph/pose_graph.hpp"
#include "prune/consensus/objective/error_scales.hpp"

namespace isotherm::slam::detail {

/// How a loop stands under an explanation.
struct Standing {
  std::pair<Index, Index> parts;  ///< of the map, by number, that its ends lie on
  /// Whether odometry or other accepted loops join its ends.
  bool connected() const { return parts.first == parts.second; }

  double chi2 = 0.0;      ///< against what they predict
  double evidence = 0.0;  ///< log of how much likelier true than false, without the prior
  double log_odds = 0.0;  ///< of true, with the prior
  LoopWeight weight;      ///< ErrorScale's, by what they predict; of accepted loops
};

}  // namespace isotherm::slam::detail
