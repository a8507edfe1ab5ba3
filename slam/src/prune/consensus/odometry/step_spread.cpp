#include "prune/consensus/odometry/step_spread.hpp"

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

template <class Pose>
std::vector<typename Pose::Tangent> steps_of(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  std::vector<typename Pose::Tangent> steps;
  for (const Index k : roles.odometry) steps.push_back(step_of(graph.constraints[k]));
  return steps;
}

// Of as many as are `spare`.
template <class Pose>
StepSpread mean_square(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                       const std::vector<typename Pose::Tangent>& steps, double spare) {
  constexpr int kTurns = Pose::kDof - Pose::kDim;
  StepSpread spread;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto& information = graph.constraints[roles.odometry[i]].information;
    const auto moves = steps[i].template head<Pose::kDim>();
    const auto turns = steps[i].template tail<kTurns>();
    spread.translation +=
        moves.dot(information.template topLeftCorner<Pose::kDim, Pose::kDim>() * moves) / spare;
    spread.rotation +=
        turns.dot(information.template bottomRightCorner<kTurns, kTurns>() * turns) / spare;
  }
  return spread;
}

}  // namespace

template <class Pose>
StepSpread step_spread(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  auto steps = steps_of(graph, roles);
  const auto count = static_cast<double>(steps.size());
  typename Pose::Tangent mean = Pose::Tangent::Zero();
  for (const auto& step : steps) mean += step / count;
  for (auto& step : steps) step -= mean;
  return mean_square(graph, roles, steps, std::max(count - 1.0, 1.0));
}

template StepSpread step_spread(const PoseGraph<Pose2>&, const EdgeRoles&);
template StepSpread step_spread(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam::detail
