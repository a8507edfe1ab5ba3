#pragma once

#include <optional>
#include <vector>

#include "prune/consensus/estimate/reduced_graph.hpp"

namespace isotherm::slam::detail {

/// A node of a reduced graph, and how odometry leads from there.
template <class Pose>
struct Anchor {
  Index node = 0;
  UncertainPose<Pose> path;
};

/// The nearest one to a vertex along odometry; none where no node is on its chain.
template <class Pose>
std::optional<Anchor<Pose>> nearest_node(const ReducedGraph<Pose>& graph, Index vertex);

/// Where a vertex lies if nodes lie at `poses`. Between two nodes, the error that odometry has
/// there is spread along it by its covariance. None where no node is on its chain.
template <class Pose>
std::optional<Pose> pose_of(const ReducedGraph<Pose>& graph, const std::vector<Pose>& poses,
                            Index vertex);

}  // namespace isotherm::slam::detail
