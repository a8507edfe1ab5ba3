#include "prune/consensus/estimate/vertex_poses.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace isotherm::slam::detail {
namespace {

template <class Pose>
typename Pose::Matrix in_first_frame(const UncertainPose<Pose>& path) {
  const typename Pose::Matrix carry = path.T.adjoint();
  return carry * path.covariance * carry.transpose();
}

// The first node at the vertex or after it.
template <class Pose>
Index node_from(const ReducedGraph<Pose>& graph, Index vertex) {
  const auto found = std::ranges::lower_bound(graph.vertex, vertex);
  return static_cast<Index>(found - graph.vertex.begin());
}

}  // namespace

template <class Pose>
std::optional<Anchor<Pose>> nearest_node(const ReducedGraph<Pose>& graph, Index vertex) {
  const Index after = node_from(graph, vertex);
  std::optional<Index> nearest;
  for (const Index node : {after - 1, after}) {
    if (node < 0 || node >= graph.node_count()) continue;
    if (graph.chain[node] != graph.odometry.chain(vertex)) continue;
    const auto apart = [&](Index a) { return std::abs(graph.vertex[a] - vertex); };
    if (!nearest || apart(node) < apart(*nearest)) nearest = node;
  }
  if (!nearest) return std::nullopt;
  return Anchor<Pose>{*nearest, graph.odometry.relative(graph.vertex[*nearest], vertex)};
}

template <class Pose>
std::optional<Pose> pose_of(const ReducedGraph<Pose>& graph, const std::vector<Pose>& poses,
                            Index vertex) {
  const auto nearest = nearest_node(graph, vertex);
  if (!nearest) return std::nullopt;
  const Index b = node_from(graph, vertex);
  const bool inside = b > 0 && b < graph.node_count() && graph.chain[b - 1] == graph.chain[b];
  if (!inside || graph.vertex[b] == vertex) return poses[nearest->node] * nearest->path.T;
  const Index first = graph.vertex[b - 1];
  const auto part = graph.odometry.relative(first, vertex);
  const auto whole = graph.odometry.relative(first, graph.vertex[b]);
  const typename Pose::Tangent error = (poses[b - 1] * whole.T).between(poses[b]).log();
  const typename Pose::Tangent share =
      in_first_frame(part) * in_first_frame(whole).ldlt().solve(whole.T.adjoint() * error);
  return poses[b - 1] * Pose::exp(share) * part.T;
}

template std::optional<Anchor<Pose2>> nearest_node(const ReducedGraph<Pose2>&, Index);
template std::optional<Anchor<Pose3>> nearest_node(const ReducedGraph<Pose3>&, Index);
template std::optional<Pose2> pose_of(const ReducedGraph<Pose2>&, const std::vector<Pose2>&, Index);
template std::optional<Pose3> pose_of(const ReducedGraph<Pose3>&, const std::vector<Pose3>&, Index);

}  // namespace isotherm::slam::detail
