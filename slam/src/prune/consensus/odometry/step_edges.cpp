#include "prune/consensus/odometry/step_edges.hpp"

#include <algorithm>
#include <limits>

#include "isotherm/slam/graph/information.hpp"

namespace isotherm::slam::detail {
namespace {

// Of a robot that never moves, or turns, nothing is known of how it does.
constexpr double kAnything = std::numeric_limits<double>::infinity();

// Squared lengths of translation and of rotation.
template <class Pose>
typename Pose::Tangent squares(const Pose& T) {
  typename Pose::Tangent result;
  result.template head<Pose::kDim>().setConstant(T.translation().squaredNorm());
  result.template tail<Pose::kDof - Pose::kDim>().setConstant(T.rotation_log().squaredNorm());
  return result;
}

// By coordinate, of those of one part the same.
template <class Pose>
void add_motion(Chain<Pose>& chain) {
  typename Pose::Tangent mean = Pose::Tangent::Zero();
  double edges = 0.0;
  for (const auto& edge : chain) {
    if (!edge) continue;
    mean += squares(edge->T);
    edges += 1.0;
  }
  mean /= std::max(edges, 1.0);
  for (auto& edge : chain) {
    if (!edge) continue;
    const typename Pose::Tangent variance = mean.cwiseMax(squares(edge->T));
    edge->motion = (variance.array() > 0.0).select(variance, kAnything);
  }
}

}  // namespace

template <class Pose>
Chain<Pose> chain_of(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  Chain<Pose> chain;
  for (const auto& edge : chain_edges(graph, roles)) {
    auto& next = chain.emplace_back();
    if (!edge) continue;
    const auto& told = graph.constraints[*edge];
    next = {forward_motion(told),
            told.from < told.to,
            covariance_from_information<Pose::kDof>(told.information),
            {}};
  }
  add_motion(chain);
  return chain;
}

template Chain<Pose2> chain_of(const PoseGraph<Pose2>&, const EdgeRoles&);
template Chain<Pose3> chain_of(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam::detail
