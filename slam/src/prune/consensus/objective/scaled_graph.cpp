#include "prune/consensus/objective/scaled_graph.hpp"

#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "graph/find_root.hpp"
#include "matrices/decompositions.hpp"
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
void slip(const Shapes<Pose>& shapes, const std::vector<std::optional<Index>>& edges,
          const Chain<Pose>& chain, PoseGraph<Pose>& graph) {
  for (std::size_t v = 0; v < edges.size(); ++v) {
    if (shapes.slips[v] == 0) continue;
    const auto Sigma = shaped(*chain[v], shapes.odometry);
    graph.constraints[*edges[v]].information =
        slipped<Pose>(*chain[v], Sigma, shapes.slips[v], shapes.slip_scale).covariance.inverse();
  }
}

template <class Pose>
void turn(const TurnBias<Pose>& bias, const std::vector<std::optional<Index>>& edges,
          PoseGraph<Pose>& graph) {
  for (const auto& edge : edges) {
    if (!edge) continue;
    auto& told = graph.constraints[*edge];
    const Pose T = turned(forward_motion(told), bias);
    told.T_from_to = told.from < told.to ? T : T.inverse();
  }
}

template <class Pose>
PoseGraph<Pose> with_shapes(PoseGraph<Pose> graph, const EdgeRoles& roles, const Chain<Pose>& chain,
                            const Shapes<Pose>& shapes) {
  apply(shapes.odometry, roles.odometry, graph);
  apply(shapes.loops, roles.candidates, graph);
  const auto edges = chain_edges(graph, roles);
  if (!shapes.slips.empty()) slip(shapes, edges, chain, graph);
  if (!shapes.bias.isZero(0.0)) turn<Pose>(shapes.bias, edges, graph);
  return graph;
}

// Poses that follow from others by the steps: all but one of each part.
template <class Pose>
Index free_poses(const ReducedGraph<Pose>& graph) {
  std::vector<Index> parent(graph.vertex.size());
  std::iota(parent.begin(), parent.end(), 0);
  Index joins = 0;
  for (const auto& step : graph.steps) {
    const Index a = find_root(parent, step.a);
    const Index b = find_root(parent, step.b);
    if (a != b) ++joins;
    parent[a] = b;
  }
  return joins;
}

template <class Pose>
std::vector<ByBias<Pose>> steps_by_bias(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                        const ReducedGraph<Pose>& reduced) {
  const auto chain = chain_edges(graph, roles);
  std::vector<ByBias<Pose>> steps;
  for (const auto& step : std::span(reduced.steps).first(reduced.contracted)) {
    ByBias<Pose> by = ByBias<Pose>::Zero();
    for (Index v = reduced.vertex[step.a]; v < reduced.vertex[step.b]; ++v) {
      by = by_bias_after<Pose>(by, forward_motion(graph.constraints[*chain[v]]));
    }
    steps.push_back(by);
  }
  return steps;
}

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
                               const Chain<Pose>& chain, const Shapes<Pose>& shapes) {
  const bool as_stated = shapes == Shapes<Pose>{};
  if (!as_stated) return scaled_graph(with_shapes(graph, roles, chain, shapes), roles, chain, {});
  ScaledGraph<Pose> scaled{.reduced = reduce(graph, roles)};
  scaled.by_bias = steps_by_bias(graph, roles, scaled.reduced);
  scaled.log_information = log_information(scaled.reduced.steps);
  scaled.variables = free_poses(scaled.reduced);
  return scaled;
}

template <class Pose>
double rotation_against_translation(const typename Pose::Tangent& shape) {
  const typename Pose::Tangent logs = shape.array().log();
  return std::exp(logs.template tail<Pose::kDof - Pose::kDim>().mean() -
                  logs.template head<Pose::kDim>().mean());
}

template ScaledGraph<Pose2> scaled_graph(const PoseGraph<Pose2>&, const EdgeRoles&,
                                         const Chain<Pose2>&, const Shapes<Pose2>&);
template ScaledGraph<Pose3> scaled_graph(const PoseGraph<Pose3>&, const EdgeRoles&,
                                         const Chain<Pose3>&, const Shapes<Pose3>&);
template double rotation_against_translation<Pose2>(const Pose2::Tangent&);
template double rotation_against_translation<Pose3>(const Pose3::Tangent&);

}  // namespace isotherm::slam::detail
