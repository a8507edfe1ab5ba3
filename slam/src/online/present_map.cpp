#include "online/present_map.hpp"

#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/optimize/optimize.hpp"

namespace isotherm::slam::detail {

template <class Pose>
void settle_poses(PoseGraph<Pose>& graph, const std::vector<bool>& is_step,
                  const std::vector<bool>& used, const Accuracy<Pose>& accuracy, Judged judged) {
  PoseGraph<Pose> part{graph.ids, graph.poses, {}, graph.fixed};
  EdgeRoles roles;
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    if (!is_step[k] && !used[k]) continue;
    auto constraint = graph.constraints[k];
    const auto& variances = is_step[k] ? accuracy.steps : accuracy.loops;
    const typename Pose::Tangent root = variances.cwiseSqrt().cwiseInverse();
    constraint.information = root.asDiagonal() * constraint.information * root.asDiagonal();
    (is_step[k] ? roles.odometry : roles.candidates).push_back(part.constraint_count());
    part.constraints.push_back(std::move(constraint));
  }
  OptimizeOptions options;
  options.kernel = judged == Judged::together ? RobustKernel::none : RobustKernel::gnc;
  options.initialization = Initialization::file;
  try {
    graph.poses = optimize(part, roles, options).poses;
  } catch (const NumericalError&) {
    return;
  }
}

template void settle_poses(PoseGraph<Pose2>&, const std::vector<bool>&, const std::vector<bool>&,
                           const Accuracy<Pose2>&, Judged);
template void settle_poses(PoseGraph<Pose3>&, const std::vector<bool>&, const std::vector<bool>&,
                           const Accuracy<Pose3>&, Judged);

}  // namespace isotherm::slam::detail
