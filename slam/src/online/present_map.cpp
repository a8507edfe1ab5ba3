#include "online/present_map.hpp"

#include <cmath>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/optimize/optimize.hpp"

namespace isotherm::slam::detail {
namespace {

// Of truncated least squares: which loops count, and where these fit best.
constexpr int kMostTurns = 10;

// A loop that others may contradict.
template <class Pose>
struct Doubtful {
  Constraint<Pose> loop;
  double most_chi2 = 0.0;

  bool fits(const std::vector<Pose>& poses) const {
    const typename Pose::Tangent r = residual(loop, poses[loop.from], poses[loop.to]);
    return r.dot(loop.information * r) <= most_chi2;
  }
};

// Where odometry alone has led says little of how well loops fit: where all do by Huber's loss,
// which a few false ones do not lead far astray, does. Loops that do not count are as if they were
// not there.
template <class Pose>
void fit(PoseGraph<Pose>& part, const EdgeRoles& roles, const std::vector<Doubtful<Pose>>& loops) {
  OptimizeOptions options{.initialization = Initialization::file};
  if (!roles.candidates.empty()) {
    options.kernel = RobustKernel::huber;
    part.poses = optimize(part, roles, options).poses;
    options.kernel = RobustKernel::none;
  }
  std::vector<bool> counts;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    std::vector<bool> now;
    for (const auto& doubtful : loops) now.push_back(doubtful.fits(part.poses));
    if (turn > 0 && now == counts) return;
    counts = std::move(now);
    for (std::size_t k = 0; k < loops.size(); ++k) {
      auto& information = part.constraints[roles.candidates[k]].information;
      information = loops[k].loop.information;
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
  std::vector<Doubtful<Pose>> doubtful;
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    if (uses[k].as == Use::As::none) continue;
    auto constraint = graph.constraints[k];
    const auto& variances = uses[k].as == Use::As::step ? accuracy.steps : accuracy.loops;
    const typename Pose::Tangent root = variances.cwiseSqrt().cwiseInverse();
    constraint.information = root.asDiagonal() * constraint.information * root.asDiagonal();
    const bool counts = std::isinf(uses[k].most_chi2);
    if (!counts) doubtful.push_back({constraint, uses[k].most_chi2});
    (counts ? roles.odometry : roles.candidates).push_back(part.constraint_count());
    part.constraints.push_back(std::move(constraint));
  }
  try {
    fit(part, roles, doubtful);
  } catch (const NumericalError&) {
    return;
  }
  graph.poses = std::move(part.poses);
}

template void settle_poses(PoseGraph<Pose2>&, const std::vector<Use>&, const Accuracy<Pose2>&);
template void settle_poses(PoseGraph<Pose3>&, const std::vector<Use>&, const Accuracy<Pose3>&);

}  // namespace isotherm::slam::detail
