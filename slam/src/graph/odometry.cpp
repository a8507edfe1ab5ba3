#include "isotherm/slam/graph/odometry.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/information.hpp"

namespace isotherm::slam {
namespace {

constexpr Index kBlock = 16;

// The step from the lower to the higher vertex, whatever the edge's direction.
template <class Pose>
UncertainPose<Pose> forward_step(const Constraint<Pose>& constraint) {
  const UncertainPose<Pose> measured{
      constraint.T_from_to, covariance_from_information<Pose::kDof>(constraint.information)};
  return constraint.from < constraint.to ? measured : inverse(measured);
}

}  // namespace

template <class Pose>
UncertainPose<Pose> compose(const UncertainPose<Pose>& first, const UncertainPose<Pose>& second) {
  const typename Pose::Matrix carry = second.T.inverse().adjoint();
  return {first.T * second.T, carry * first.covariance * carry.transpose() + second.covariance};
}

template <class Pose>
UncertainPose<Pose> inverse(const UncertainPose<Pose>& pose) {
  const typename Pose::Matrix carry = pose.T.adjoint();
  return {pose.T.inverse(), carry * pose.covariance * carry.transpose()};
}

template <class Pose>
std::vector<std::optional<Index>> chain_edges(const PoseGraph<Pose>& graph,
                                              const EdgeRoles& roles) {
  std::vector<std::optional<Index>> edges(std::max<Index>(graph.vertex_count(), 1) - 1);
  for (const Index k : roles.odometry) {
    const auto& constraint = graph.constraints[k];
    if (std::abs(constraint.from - constraint.to) != 1) continue;
    auto& edge = edges[std::min(constraint.from, constraint.to)];
    if (!edge) edge = k;
  }
  return edges;
}

template <class Pose>
OdometryChain<Pose>::OdometryChain(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  const Index n = graph.vertex_count();
  if (n == 0) return;
  steps_.resize(n - 1);
  chain_.assign(n, 0);
  const auto edges = chain_edges(graph, roles);
  for (Index v = 1; v < n; ++v) {
    const auto& edge = edges[v - 1];
    if (edge) steps_[v - 1] = forward_step(graph.constraints[*edge]);
    chain_[v] = chain_[v - 1] + (edge ? 0 : 1);
  }

  // Blocks across a gap between chains are never asked for.
  std::vector<UncertainPose<Pose>> blocks((n - 1) / kBlock);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto first = static_cast<Index>(b) * kBlock;
    append_steps(first, first + kBlock, blocks[b]);
  }
  while (!blocks.empty()) {
    std::vector<UncertainPose<Pose>> doubled(blocks.size() / 2);
    for (std::size_t b = 0; b < doubled.size(); ++b) {
      doubled[b] = compose(blocks[2 * b], blocks[2 * b + 1]);
    }
    levels_.push_back(std::move(blocks));
    blocks = std::move(doubled);
  }
}

template <class Pose>
UncertainPose<Pose> OdometryChain<Pose>::relative(Index from, Index to) const {
  const Index n = vertex_count();
  if (from < 0 || from >= n || to < 0 || to >= n) {
    throw InvalidArgument("vertex", "outside [0, " + std::to_string(n) + ")");
  }
  if (chain_[from] != chain_[to]) {
    throw InvalidArgument("vertex", "no odometry path between the two vertices");
  }
  return from <= to ? forward(from, to) : inverse(forward(to, from));
}

template <class Pose>
void OdometryChain<Pose>::append_steps(Index first, Index last, UncertainPose<Pose>& path) const {
  for (Index k = first; k < last; ++k) path = compose(path, steps_[k]);
}

template <class Pose>
UncertainPose<Pose> OdometryChain<Pose>::forward(Index from, Index to) const {
  UncertainPose<Pose> path;
  Index at = from;
  while (at < to) {
    // The largest kept block that starts here and does not overshoot.
    std::size_t level = 0;
    Index span = kBlock;
    if (at % kBlock != 0 || at + kBlock > to) {
      const Index stop = std::min(to, (at / kBlock + 1) * kBlock);
      append_steps(at, stop, path);
      at = stop;
      continue;
    }
    while (level + 1 < levels_.size() && at % (2 * span) == 0 && at + 2 * span <= to) {
      span *= 2;
      ++level;
    }
    path = compose(path, levels_[level][at / span]);
    at += span;
  }
  return path;
}

template <class Pose>
std::vector<Pose> odometry_poses(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  const auto edges = chain_edges(graph, roles);
  std::vector<Pose> poses(graph.ids.size());
  for (std::size_t v = 0; v < poses.size(); ++v) {
    if (v == 0 || !edges[v - 1]) {
      if (!graph.poses.empty()) poses[v] = graph.poses[v];
      continue;
    }
    poses[v] = poses[v - 1] * forward_motion(graph.constraints[*edges[v - 1]]);
  }
  return poses;
}

template class OdometryChain<Pose2>;
template class OdometryChain<Pose3>;
template UncertainPose<Pose2> compose(const UncertainPose<Pose2>&, const UncertainPose<Pose2>&);
template UncertainPose<Pose3> compose(const UncertainPose<Pose3>&, const UncertainPose<Pose3>&);
template UncertainPose<Pose2> inverse(const UncertainPose<Pose2>&);
template UncertainPose<Pose3> inverse(const UncertainPose<Pose3>&);
template std::vector<std::optional<Index>> chain_edges(const PoseGraph<Pose2>&, const EdgeRoles&);
template std::vector<std::optional<Index>> chain_edges(const PoseGraph<Pose3>&, const EdgeRoles&);
template std::vector<Pose2> odometry_poses(const PoseGraph<Pose2>&, const EdgeRoles&);
template std::vector<Pose3> odometry_poses(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam
