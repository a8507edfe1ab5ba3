#include "online/present_map.hpp"

#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/optimize/optimize.hpp"

namespace isotherm::slam::detail {
namespace {

// Of truncated least squares: which loops count, and where these fit best.
constexpr int kMostTurns = 10;

// Which of these lie within the width that truncated least squares have by default.
template <class Pose>
std::vector<bool> fitting(const std::vector<Constraint<Pose>>& loops,
                          const std::vector<Pose>& poses) {
  const double width = default_kernel_width(RobustKernel::gnc, Pose::kDof);
  std::vector<bool> fits;
  for (const auto& loop : loops) {
    const typename Pose::Tangent r = residual(loop, poses[loop.from], poses[loop.to]);
    fits.push_back(r.dot(loop.information * r) <= width);
  }
  return fits;
}

// Where odometry alone has led says little of how well loops fit: where all do by Huber's loss,
// which a few false ones do not lead far astray, does. Loops that do not count are as if they were
// not there.
template <class Pose>
void fit(PoseGraph<Pose>& part, const EdgeRoles& roles) {
  OptimizeOptions options{.initialization = Initialization::file};
  if (!roles.candidates.empty()) {
    options.kernel = RobustKernel::huber;
    part.poses = optimize(part, roles, options).poses;
    options.kernel = RobustKernel::none;
  }
  std::vector<Constraint<Pose>> loops;
  for (const Index k : roles.candidates) loops.push_back(part.constraints[k]);
  std::vector<bool> counts;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    auto now = fitting(loops, part.poses);
    if (turn > 0 && now == counts) return;
    counts = std::move(now);
    for (std::size_t k = 0; k < loops.size(); ++k) {
      auto& information = part.constraints[roles.candidates[k]].information;
      information = loops[k].information;
      if (!counts[k]) information.setZero();
    }
    part.poses = optimize(part, roles, options).poses;
  }
}

}  // namespace

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
    fit(part, roles);
  } catch (const NumericalError&) {
    return;
  }
  graph.poses = std::move(part.poses);
}

template void settle_poses(PoseGraph<Pose2>&, const std::vector<Use>&, const Accuracy<Pose2>&);
template void settle_poses(PoseGraph<Pose3>&, const std::vector<Use>&, const Accuracy<Pose3>&);

}  // namespace isotherm::slam::detail
