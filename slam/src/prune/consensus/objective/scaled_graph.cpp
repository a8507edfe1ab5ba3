#include "prune/consensus/objective/scaled_graph.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace isotherm::slam::detail {
namespace {

template <class Pose>
void apply(const typename Pose::Tangent& shape, const std::vector<Index>& edges,
           PoseGraph<Pose>& graph) {
  const typename Pose::Tangent root = shape.cwiseSqrt().cwiseInverse();
  for (const Index k : edges) {
    auto& information = graph.constraints[k].information;
    information = root.asDiagonal() * information * root.asDiagonal();
  }
}

template <class Pose>
PoseGraph<Pose> with_shapes(PoseGraph<Pose> graph, const EdgeRoles& roles,
                            const Shapes<Pose>& shapes) {
  apply(shapes.odometry, roles.odometry, graph);
  apply(shapes.loops, roles.candidates, graph);
  return graph;
}

}  // namespace

template <class Pose>
ScaledGraph<Pose> scaled_graph(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                               const Shapes<Pose>& shapes) {
  ScaledGraph<Pose> scaled{shapes == Shapes<Pose>{}
                               ? reduce(graph, roles)
                               : reduce(with_shapes(graph, roles, shapes), roles)};
  Estimate<Pose> odometry(scaled.reduced);
  odometry.update(std::vector<bool>(scaled.reduced.loops.size(), false), {}, 0);
  scaled.log_determinant = odometry.log_determinant();
  scaled.variables = odometry.variable_count();
  return scaled;
}

template <class Pose>
double rotation_against_translation(const typename Pose::Tangent& shape) {
  const typename Pose::Tangent logs = shape.array().log();
  return std::exp(logs.template tail<Pose::kDof - Pose::kDim>().mean() -
                  logs.template head<Pose::kDim>().mean());
}

template ScaledGraph<Pose2> scaled_graph(const PoseGraph<Pose2>&, const EdgeRoles&,
                                         const Shapes<Pose2>&);
template ScaledGraph<Pose3> scaled_graph(const PoseGraph<Pose3>&, const EdgeRoles&,
                                         const Shapes<Pose3>&);
template double rotation_against_translation<Pose2>(const Pose2::Tangent&);
template double rotation_against_translation<Pose3>(const Pose3::Tangent&);

}  // namespace isotherm::slam::detail
