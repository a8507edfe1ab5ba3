#include "proven_loops.hpp"

#include "map_volume.hpp"
#include "prediction.hpp"

namespace isotherm::slam::detail {

template <class Pose>
Index count_proven(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                   const std::vector<bool>& accepted, double loop_scale, double required_odds) {
  std::vector<Index> loops;
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    if (accepted[k]) loops.push_back(static_cast<Index>(k));
  }
  const auto covariances = estimate.relative_covariances(loops);
  const MapVolume<Pose> map(estimate.layout().poses);
  Index count = 0;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto& link = graph.loops[loops[k]];
    const Evidence evidence =
        weigh_held_out(link, estimate.residual(link), covariances[k], loop_scale, map);
    if (evidence.log_ratio >= required_odds) ++count;
  }
  return count;
}

template Index count_proven(const ReducedGraph<Pose2>&, const Estimate<Pose2>&,
                            const std::vector<bool>&, double, double);
template Index count_proven(const ReducedGraph<Pose3>&, const Estimate<Pose3>&,
                            const std::vector<bool>&, double, double);

}  // namespace isotherm::slam::detail
