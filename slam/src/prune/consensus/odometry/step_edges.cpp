#include "prune/consensus/odometry/step_edges.hpp"

#include "isotherm/slam/graph/information.hpp"

namespace isotherm::slam::detail {

template <class Pose>
Chain<Pose> chain_of(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  Chain<Pose> chain;
  for (const auto& edge : chain_edges(graph, roles)) {
    auto& next = chain.emplace_back();
    if (!edge) continue;
    const auto& told = graph.constraints[*edge];
    next = {forward_motion(told), told.from < told.to,
            covariance_from_information<Pose::kDof>(told.information)};
  }
  return chain;
}

template Chain<Pose2> chain_of(const PoseGraph<Pose2>&, const EdgeRoles&);
template Chain<Pose3> chain_of(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam::detail
