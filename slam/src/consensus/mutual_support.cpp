#include "mutual_support.hpp"

#include <algorithm>

namespace isotherm::slam::detail {

template <class Pose>
MutualSupport mutual_support(const ReducedGraph<Pose>& graph,
                             const std::vector<std::pair<Index, Index>>& pairs,
                             const MapVolume<Pose>& map, const CovarianceScale& scale,
                             double gate) {
  const auto loops = forward_loops(graph, scale);
  MutualSupport support;
  for (const auto& [first, second] : pairs) {
    const Evidence evidence = compare(graph, scale, loops[first], loops[second], map);
    auto& kind = evidence.chi2 <= gate ? support.agreeing : support.contradicting;
    kind.push_back({first, second, evidence.log_ratio});
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
