#include "prune/consensus/estimate/reduced_graph.hpp"

#include <algorithm>
#include <iterator>

#include "isotherm/slam/graph/information.hpp"

namespace isotherm::slam::detail {
namespace {

std::vector<Index> endpoints(const std::vector<bool>& touched) {
  std::vector<Index> vertices;
  for (std::size_t v = 0; v < touched.size(); ++v) {
    if (touched[v]) vertices.push_back(static_cast<Index>(v));
  }
  return vertices;
}

// Trusted edges that are not steps of an odometry chain: those that a user named,
// and repeats.
template <class Pose>
std::vector<Index> trusted_beside_chains(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  std::vector<bool> in_chain(graph.constraints.size(), false);
  for (const auto& edge : chain_edges(graph, roles)) {
    if (edge) in_chain[*edge] = true;
  }
  std::vector<Index> others;
  std::ranges::copy_if(roles.odometry, std::back_inserter(others),
                       [&](Index k) { return !in_chain[k]; });
  return others;
}

template <class Pose>
Link<Pose> link(const Constraint<Pose>& constraint, const std::vector<Index>& node) {
  const auto covariance = covariance_from_information<Pose::kDof>(constraint.information);
  return {node[constraint.from], node[constraint.to], constraint.T_from_to, covariance,
          covariance_from_information<Pose::kDof>(covariance)};
}

}  // namespace

template <class Pose>
typename Pose::Matrix ReducedGraph<Pose>::odometry_covariance(const Link<Pose>& loop) const {
  if (!same_chain(loop)) return kUnknownVariance * Pose::Matrix::Identity();
  return odometry.relative(vertex[loop.a], vertex[loop.b]).covariance;
}

template <class Pose>
ReducedGraph<Pose> reduce(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  std::vector<bool> touched(graph.ids.size(), false);
  const auto others = trusted_beside_chains(graph, roles);
  for (const auto* edges : {&roles.candidates, &others}) {
    for (const Index k : *edges) {
      touched[graph.constraints[k].from] = true;
      touched[graph.constraints[k].to] = true;
    }
  }
  const auto all_poses = odometry_poses(graph, roles);

  ReducedGraph<Pose> reduced{.odometry = OdometryChain<Pose>(graph, roles)};
  const auto& odometry = reduced.odometry;
  reduced.vertex = endpoints(touched);
  std::vector<Index> node(graph.ids.size(), -1);
  for (Index a = 0; a < reduced.node_count(); ++a) {
    const Index vertex = reduced.vertex[a];
    node[vertex] = a;
    reduced.chain.push_back(odometry.chain(vertex));
    reduced.poses.push_back(all_poses[vertex]);
  }
  for (Index b = 1; b < reduced.node_count(); ++b) {
    const Index a = b - 1;
    if (reduced.chain[a] != reduced.chain[b]) continue;
    const auto path = odometry.relative(reduced.vertex[a], reduced.vertex[b]);
    reduced.steps.push_back(
        {a, b, path.T, path.covariance, covariance_from_information<Pose::kDof>(path.covariance)});
  }
  reduced.contracted = reduced.steps.size();
  for (const Index k : others) {
    if (graph.constraints[k].from != graph.constraints[k].to) {
      reduced.steps.push_back(link(graph.constraints[k], node));
    }
  }
  for (const Index k : roles.candidates) reduced.loops.push_back(link(graph.constraints[k], node));
  return reduced;
}

template struct ReducedGraph<Pose2>;
template struct ReducedGraph<Pose3>;
template ReducedGraph<Pose2> reduce(const PoseGraph<Pose2>&, const EdgeRoles&);
template ReducedGraph<Pose3> reduce(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam::detail
