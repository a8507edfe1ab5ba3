#include "prune/consensus/pairs/mutual_support.hpp"

#include <algorithm>

namespace isotherm::slam::detail {

template <class Pose>
MutualSupport mutual_support(const ReducedGraph<Pose>& graph,
                             const std::vector<std::pair<Index, Index>>& pairs,
                             const MapVolume<Pose>& map, const CovarianceScale& scale,
                             double gate) {
  const auto evidence = compare_pairs(graph, pairs, map, scale);
  MutualSupport support;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [first, second] = pairs[k];
    const bool agree = evidence[k].chi2 <= gate;
    const Support pair{first, second, evidence[k].log_ratio, evidence[k].chi2};
    if (!is_copy(graph.loops[first], graph.loops[second])) {
      (agree ? support.agreeing : support.contradicting).push_back(pair);
    } else if (agree) {
      support.copied.push_back(pair);
    }
  }
  std::stable_sort(support.agreeing.begin(), support.agreeing.end(),
                   [](const Support& a, const Support& b) { return a.gain > b.gain; });
  return support;
}

template MutualSupport mutual_support(const ReducedGraph<Pose2>&,
                                      const std::vector<std::pair<Index, Index>>&,
                                      const MapVolume<Pose2>&, const CovarianceScale&, double);
template MutualSupport mutual_support(const ReducedGraph<Pose3>&,
                                      const std::vector<std::pair<Index, Index>>&,
                                      const MapVolume<Pose3>&, const CovarianceScale&, double);

}  // namespace isotherm::slam::detail
