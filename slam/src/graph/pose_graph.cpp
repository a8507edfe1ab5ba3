#include "isotherm/slam/graph/pose_graph.hpp"

#include <algorithm>
#include <cstdlib>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

// GTSAM keys carry the robot's letter in the top byte.
VertexId robot_of(VertexId id) { return id >> 56; }

}  // namespace

template <class Pose>
std::optional<Index> PoseGraph<Pose>::find(VertexId id) const {
  const auto found = std::lower_bound(ids.begin(), ids.end(), id);
  if (found == ids.end() || *found != id) return std::nullopt;
  return static_cast<Index>(found - ids.begin());
}

template <class Pose>
EdgeRoles edge_roles(const PoseGraph<Pose>& graph) {
  EdgeRoles roles;
  std::vector<bool> step_taken(graph.ids.size(), false);
  for (Index k = 0; k < graph.constraint_count(); ++k) {
    const auto& constraint = graph.constraints[k];
    const Index first = std::min(constraint.from, constraint.to);
    const Index second = std::max(constraint.from, constraint.to);
    const bool neighbours =
        second - first == 1 && robot_of(graph.ids[first]) == robot_of(graph.ids[second]);
    if (neighbours && !step_taken[first]) {
      step_taken[first] = true;
      roles.odometry.push_back(k);
    } else {
      roles.candidates.push_back(k);
    }
  }
  return roles;
}

template <class Pose>
PoseGraph<Pose> filter_constraints(const PoseGraph<Pose>& graph, const std::vector<bool>& keep) {
  if (keep.size() != graph.constraints.size()) {
    throw InvalidArgument("keep", "must have one entry per constraint");
  }
  PoseGraph<Pose> kept{graph.ids, graph.poses, {}, graph.fixed};
  for (std::size_t k = 0; k < keep.size(); ++k) {
    if (keep[k]) kept.constraints.push_back(graph.constraints[k]);
  }
  return kept;
}

template <class Pose>
typename Pose::Tangent residual(const Constraint<Pose>& constraint, const Pose& T_world_from,
                                const Pose& T_world_to) {
  return (constraint.T_from_to.inverse() * (T_world_from.inverse() * T_world_to)).log();
}

template struct PoseGraph<Pose2>;
template struct PoseGraph<Pose3>;
template EdgeRoles edge_roles(const PoseGraph<Pose2>&);
template EdgeRoles edge_roles(const PoseGraph<Pose3>&);
template PoseGraph<Pose2> filter_constraints(const PoseGraph<Pose2>&, const std::vector<bool>&);
template PoseGraph<Pose3> filter_constraints(const PoseGraph<Pose3>&, const std::vector<bool>&);
template Pose2::Tangent residual(const Constraint<Pose2>&, const Pose2&, const Pose2&);
template Pose3::Tangent residual(const Constraint<Pose3>&, const Pose3&, const Pose3&);

}  // namespace isotherm::slam
