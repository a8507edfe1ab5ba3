#include "prune/consensus/estimate/step_spread.hpp"

#include <algorithm>
#include <vector>

namespace isotherm::slam::detail {
namespace {

// From the vertex before to the one after, whichever end tells it.
template <class Pose>
typename Pose::Tangent step_of(const Constraint<Pose>& edge) {
  const Pose T = edge.from < edge.to ? edge.T_from_to : edge.T_from_to.inverse();
  typename Pose::Tangent step;
  step << T.translation(), T.rotation_log();
  return step;
}

}  // namespace

template <class Pose>
StepSpread step_spread(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  constexpr int kTurns = Pose::kDof - Pose::kDim;
  std::vector<typename Pose::Tangent> steps;
  typename Pose::Tangent mean = Pose::Tangent::Zero();
  for (const Index k : roles.odometry) {
    steps.push_back(step_of(graph.constraints[k]));
    mean += steps.back();
  }
  StepSpread spread;
  const auto count = static_cast<double>(steps.size());
  mean /= std::max(count, 1.0);
  const double spare = std::max(count - 1.0, 1.0);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto& information = graph.constraints[roles.odometry[i]].information;
    const typename Pose::Tangent off = steps[i] - mean;
    const auto moves = off.template head<Pose::kDim>();
    const auto turns = off.template tail<kTurns>();
    spread.translation +=
        moves.dot(information.template topLeftCorner<Pose::kDim, Pose::kDim>() * moves) / spare;
    spread.rotation +=
        turns.dot(information.template bottomRightCorner<kTurns, kTurns>() * turns) / spare;
  }
  return spread;
}

template StepSpread step_spread(const PoseGraph<Pose2>&, const EdgeRoles&);
template StepSpread step_spread(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam::detail
