#include "prune/consensus/estimate/held_out.hpp"

#include "prune/consensus/estimate/prediction.hpp"

namespace isotherm::slam::detail {

template <class Pose>
std::vector<HeldOut> held_out(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                              const std::vector<bool>& accepted, double loop_scale,
                              const MapVolume<Pose>& map) {
  std::vector<Index> loops;
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    if (accepted[k] && graph.loops[k].a != graph.loops[k].b) {
      loops.push_back(static_cast<Index>(k));
    }
  }
  const auto covariances = estimate.relative_covariances(loops);
  std::vector<HeldOut> result;
  result.reserve(loops.size());
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto& link = graph.loops[loops[k]];
    result.push_back(
        {loops[k], weigh_held_out(link, estimate.residual(link), covariances[k], loop_scale, map)});
  }
  return result;
}

template std::vector<HeldOut> held_out(const ReducedGraph<Pose2>&, const Estimate<Pose2>&,
                                       const std::vector<bool>&, double, const MapVolume<Pose2>&);
template std::vector<HeldOut> held_out(const ReducedGraph<Pose3>&, const Estimate<Pose3>&,
                                       const std::vector<bool>&, double, const MapVolume<Pose3>&);

}  // namespace isotherm::slam::detail
