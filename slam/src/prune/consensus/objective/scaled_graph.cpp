#include "prune/consensus/objective/scaled_graph.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "prune/consensus/estimate/log_normal.hpp"

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

// Of those that have nodes.
template <class Pose>
std::size_t chain_count(const ReducedGraph<Pose>& graph) {
  std::vector<Index> chains = graph.chain;
  std::ranges::sort(chains);
  chains.erase(std::unique(chains.begin(), chains.end()), chains.end());
  return chains.size();
}

// log |H| of links none of which closes a cycle: a change of frame is of determinant 1.
template <class Pose>
double log_information(const std::vector<Link<Pose>>& links) {
  double sum = 0.0;
  for (const auto& link : links) {
    sum += log_determinant(Eigen::LLT<typename Pose::Matrix>(link.information));
  }
  return sum;
}

}  // namespace

template <class Pose>
ScaledGraph<Pose> scaled_graph(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                               const Shapes<Pose>& shapes) {
  ScaledGraph<Pose> scaled{shapes == Shapes<Pose>{}
                               ? reduce(graph, roles)
                               : reduce(with_shapes(graph, roles, shapes), roles)};
  const ReducedGraph<Pose>& reduced = scaled.reduced;
  if (reduced.steps.size() + chain_count(reduced) == reduced.vertex.size()) {
    scaled.log_determinant = log_information(reduced.steps);
    scaled.variables = static_cast<Index>(reduced.steps.size());
    return scaled;
  }
  Estimate<Pose> odometry(reduced);
  odometry.update(std::vector<bool>(reduced.loops.size(), false), {}, 0);
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
