#pragma once

#include <optional>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// A relative pose with its uncertainty: the true pose is T exp(xi) with
/// xi ~ N(0, covariance), ordered (translation, rotation).
template <class Pose>
struct UncertainPose {
  Pose T;
  typename Pose::Matrix covariance = Pose::Matrix::Zero();
};

/// `first` followed by `second`, to first order in the uncertainties, which are
/// taken as independent.
template <class Pose>
UncertainPose<Pose> compose(const UncertainPose<Pose>& first, const UncertainPose<Pose>& second);

template <class Pose>
UncertainPose<Pose> inverse(const UncertainPose<Pose>& pose);

/// Of each vertex but the last, the edge that joins it to the next one in its odometry chain: the
/// first of roles.odometry between the two, if any.
template <class Pose>
std::vector<std::optional<Index>> chain_edges(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

/// What such an edge says of the motion from its earlier vertex to the later one.
template <class Pose>
Pose forward_motion(const Constraint<Pose>& edge) {
  return edge.from < edge.to ? edge.T_from_to : edge.T_from_to.inverse();
}

/// Relative poses along odometry, with covariance, in O(log n) each.
///
/// The composition of every block of 16, 32, 64, ... steps is kept, and a query
/// joins O(log n) of them. Differences of sums accumulated from the origin would
/// be O(1), but they cancel badly far from it. Memory is O(n / 8) entries.
template <class Pose>
class OdometryChain {
 public:
  /// Uses chain_edges(); trusted edges between other vertices are left out. O(n).
  OdometryChain(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

  Index vertex_count() const noexcept { return static_cast<Index>(chain_.size()); }

  /// Vertices joined by odometry have the same number; numbered from 0 in order.
  Index chain(Index vertex) const { return chain_[static_cast<std::size_t>(vertex)]; }
  Index chain_count() const noexcept { return chain_.empty() ? 0 : chain_.back() + 1; }

  /// The pose of `to` in the frame of `from`.
  /// @throws InvalidArgument if the two are not on one chain.
  UncertainPose<Pose> relative(Index from, Index to) const;

 private:
  UncertainPose<Pose> forward(Index from, Index to) const;  // from <= to
  void append_steps(Index first, Index last, UncertainPose<Pose>& path) const;

  std::vector<Index> chain_;
  std::vector<UncertainPose<Pose>> steps_;                // step k leads from k to k + 1
  std::vector<std::vector<UncertainPose<Pose>>> levels_;  // levels_[l][b]: 16 * 2^l steps
};

/// Poses by chaining odometry: each chain starts where the graph's own poses put
/// its first vertex, or at the identity if the graph has none.
template <class Pose>
std::vector<Pose> odometry_poses(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

}  // namespace isotherm::slam
