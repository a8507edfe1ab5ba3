#include "online/present_map.hpp"

#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/optimize/optimize.hpp"

namespace isotherm::slam::detail {
namespace {

// Of truncated least squares, which loops count and where these fit best; two or three are usual.
constexpr int kMostTurns = 10;

// Which of these loops lie within the width that truncated least squares have by default.
template <class Pose>
std::vector<bool> fitting(const PoseGraph<Pose>& graph, const std::vector<Index>& loops,
                          const std::vector<Pose>& poses) {
  const double width = default_kernel_width(RobustKernel::gnc, Pose::kDof);
  std::vector<bool> fits;
  for (const Index k : loops) {
    const auto& [from, to, measured, information, line, link] = graph.constraints[k];
    const typename Pose::Tangent r = (measured.inverse() * poses[from].inverse() * poses[to]).log();
    fits.push_back(r.dot(information * r) <= width);
  }
  return fits;
}

// Those that do not count are as if they were not there.
template <class Pose>
void count(const PoseGraph<Pose>& all, const std::vector<Index>& loops,
           const std::vector<bool>& counts, PoseGraph<Pose>& part) {
  for (std::size_t k = 0; k < loops.size(); ++k) {
    auto& information = part.constraints[loops[k]].information;
    information = all.constraints[loops[k]].information;
    if (!counts[k]) information.setZero();
  }
}

// Where odometry alone has led says little of how well loops fit: where all do by Huber's loss,
// which a few false ones do not lead far astray, does.
template <class Pose>
void fit(PoseGraph<Pose>& part, const EdgeRoles& roles) {
  OptimizeOptions options{.initialization = Initialization::file};
  if (!roles.candidates.empty()) {
    options.kernel = RobustKernel::huber;
    part.poses = optimize(part, roles, options).poses;
    options.kernel = RobustKernel::none;
  }
  const PoseGraph<Pose> all = part;
  std::vector<bool> counts;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    auto now = fitting(all, roles.candidates, part.poses);
    if (turn > 0 && now == counts) return;
    counts = std::move(now);
    count(all, roles.candidates, counts, part);
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
