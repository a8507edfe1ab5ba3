#include "prune/consensus/objective/scaled_graph.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace isotherm::slam::detail {
namespace {

template <class Pose>
PoseGraph<Pose> with_ratio(PoseGraph<Pose> graph, double ratio) {
  const typename Pose::Tangent root =
      PartScales<Pose>(ratio).by_coordinate().cwiseSqrt().cwiseInverse();
  for (auto& constraint : graph.constraints) {
    constraint.information = root.asDiagonal() * constraint.information * root.asDiagonal();
  }
  return graph;
}

}  // namespace

template <class Pose>
PartScales<Pose>::PartScales(double ratio) {
  constexpr double kShare = static_cast<double>(Pose::kDim) / Pose::kDof;
  rotation = std::pow(ratio, kShare);
  translation = rotation / ratio;
}

template <class Pose>
typename Pose::Tangent PartScales<Pose>::by_coordinate() const {
  typename Pose::Tangent scales;
  scales.template head<Pose::kDim>().setConstant(translation);
  scales.template tail<Pose::kDof - Pose::kDim>().setConstant(rotation);
  return scales;
}

template <class Pose>
ScaledGraph<Pose> scaled_graph(const PoseGraph<Pose>& graph, const EdgeRoles& roles, double ratio) {
  ScaledGraph<Pose> scaled{ratio == 1.0 ? reduce(graph, roles)
                                        : reduce(with_ratio(graph, ratio), roles)};
  Estimate<Pose> odometry(scaled.reduced);
  odometry.update(std::vector<bool>(scaled.reduced.loops.size(), false), {}, 0);
  scaled.log_determinant = odometry.log_determinant();
  scaled.variables = odometry.variable_count();
  return scaled;
}

template struct PartScales<Pose2>;
template struct PartScales<Pose3>;
template ScaledGraph<Pose2> scaled_graph(const PoseGraph<Pose2>&, const EdgeRoles&, double);
template ScaledGraph<Pose3> scaled_graph(const PoseGraph<Pose3>&, const EdgeRoles&, double);

}  // namespace isotherm::slam::detail
