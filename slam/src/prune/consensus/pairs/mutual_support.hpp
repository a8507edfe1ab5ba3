#pragma once

#include <utility>
#include <vector>

#include "prune/consensus/pairs/loop_pair.hpp"

namespace isotherm::slam::detail {

/// Two loops that confirm each other.
struct Support {
  Index first = 0;
  Index second = 0;
  /// Log density of one loop's measurement as the other predicts it, relative to
  /// "anywhere on the map".
  double gain = 0.0;
  double chi2 = 0.0;  ///< of the same
};

/// How loops with neighbouring ends agree with each other.
struct MutualSupport {
  std::vector<Support> agreeing;       ///< by descending gain
  std::vector<Support> contradicting;  ///< chi-squared outside the gate
  /// Those that agree, but of which one repeats the measurement of the other (is_copy):
  /// that is no confirmation, nor is it news if they contradict each other.
  std::vector<Support> copied;
};

/// Compares the loops of each of `pairs` (near_pairs).
///
/// One loop and the two short pieces of odometry between the ends predict the
/// other loop; the prediction does not depend on the estimate, nor on how far
/// odometry has drifted between the two ends. O(pairs log n).
template <class Pose>
MutualSupport mutual_support(const ReducedGraph<Pose>& graph,
                             const std::vector<std::pair<Index, Index>>& pairs,
                             const MapVolume<Pose>& map, const CovarianceScale& scale, double gate);

}  // namespace isotherm::slam::detail
