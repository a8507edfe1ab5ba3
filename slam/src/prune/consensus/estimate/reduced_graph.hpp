#pragma once

#include <cstdlib>
#include <vector>

#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

/// A measured relative pose between two nodes of a reduced graph.
template <class Pose>
struct Link {
  Index a = 0;
  Index b = 0;
  Pose T_a_b;
  typename Pose::Matrix covariance = Pose::Matrix::Zero();
  typename Pose::Matrix information = Pose::Matrix::Zero();
};

/// A pose graph of which only the poses that candidates touch are left.
///
/// Between neighbouring endpoints odometry is contracted into one step, with the
/// covariance propagated along it. For the linearised problem that is exact: it
/// eliminates the poses in between. At most two nodes a candidate.
template <class Pose>
struct ReducedGraph {
  OdometryChain<Pose> odometry;   ///< of the full graph
  std::vector<Index> vertex;      ///< of the full graph, one a node, ascending
  std::vector<Index> chain;       ///< odometry chain a node
  std::vector<Pose> poses;        ///< chained odometry
  std::vector<Link<Pose>> steps;  ///< contracted odometry, then other trusted edges
  std::size_t contracted = 0;     ///< of the steps, along chains: the first
  std::vector<Link<Pose>> loops;  ///< one a candidate, in order

  Index node_count() const noexcept { return static_cast<Index>(vertex.size()); }
  bool same_chain(const Link<Pose>& loop) const { return chain[loop.a] == chain[loop.b]; }

  /// Whether it is told from the earlier vertex.
  bool is_forward(const Link<Pose>& loop) const { return vertex[loop.a] <= vertex[loop.b]; }

  /// Covariance of T_a^-1 T_b under odometry alone, as a perturbation on the right; beyond every
  /// map where the ends are on different chains.
  typename Pose::Matrix odometry_covariance(const Link<Pose>& loop) const;

  /// Vertices of the full graph between the ends of a loop.
  Index span(Index loop) const { return std::abs(vertex[loops[loop].a] - vertex[loops[loop].b]); }
};

/// O(n + q log n). @throws NumericalError for information that is not finite
template <class Pose>
ReducedGraph<Pose> reduce(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

}  // namespace isotherm::slam::detail
