#include "online/present_map.hpp"

#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/optimize/optimize.hpp"

namespace isotherm::slam::detail {

template <class Pose>
void settle_poses(PoseGraph<Pose>& graph, const std::vector<Use>& uses,
                  const Accuracy<Pose>& accuracy) {
  PoseGraph<Pose> part{graph.ids, graph.poses, {}, graph.fixed};
  EdgeRoles roles;
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    if (uses[k] == Use::none) continue;
    auto constraint = graph.constraints[k];
    const auto& variances = uses[k] == Use::step ? accuracy.steps : accuracy.loops;
    const typename Pose::Tangent root = variances.cwiseSqrt().cwiseInverse();
    constraint.information = root.asDiagonal() * constraint.information * root.asDiagonal();
    const bool doubtful = uses[k] == Use::loop_as_it_came;
    (doubtful ? roles.candidates : roles.odometry).push_back(part.constraint_count());
    part.constraints.push_back(std::move(constraint));
  }
  try {
    // How well loops fit where odometry alone has led says little of them; and a few false ones
    // must not lead the rest astray.
    for (const auto kernel : {RobustKernel::huber, RobustKernel::gnc}) {
      if (kernel == RobustKernel::gnc && roles.candidates.empty()) break;
      part.poses =
          optimize(part, roles, {.kernel = kernel, .initialization = Initialization::file}).poses;
    }
  } catch (const NumericalError&) {
    return;
  }
  graph.poses = std::move(part.poses);
}

template void settle_poses(PoseGraph<Pose2>&, const std::vector<Use>&, const Accuracy<Pose2>&);
template void settle_poses(PoseGraph<Pose3>&, const std::vector<Use>&, const Accuracy<Pose3>&);

}  // namespace isotherm::slam::detail
