#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

/// All edges that have come, in that order, by the ids of their ends.
template <class Pose>
class EdgeLog {
 public:
  struct Edge {
    VertexId from = 0;
    VertexId to = 0;
    Constraint<Pose> measured;  // ends not set
    bool step = false;          // taken for odometry when it came
  };

  /// The step that leads to a vertex from the one before it.
  struct Step {
    VertexId before = 0;
    UncertainPose<Pose> measured;  // as told from its own end (in_own_frame())
    bool forward = true;           // told from that one

    /// From that one, with these factors on the variances.
    UncertainPose<Pose> path(const typename Pose::Tangent& variances) const;
  };

  /// @throws InvalidArgument for what is not finite, or no information
  const Edge& add(VertexId from, VertexId to, const Pose& T_from_to,
                  const typename Pose::Matrix& information, LinkKind link);
  void set_pose(VertexId id, const Pose& pose);
  void fix(VertexId id);

  const std::vector<Edge>& edges() const noexcept { return edges_; }
  const std::map<VertexId, Pose>& poses() const noexcept { return poses_; }
  /// The vertices that set_pose() and fix() named, in that order.
  const std::vector<VertexId>& posed() const noexcept { return posed_; }
  const std::vector<VertexId>& fixed() const noexcept { return fixed_; }

  /// As of when it came; null for the first vertex of a chain.
  const Step* step_to(VertexId id) const;

  /// An earlier edge that says the same, between the same vertices in the same direction.
  std::optional<Index> repeated_by(const Edge& edge) const;

  PoseGraph<Pose> graph() const;

 private:
  bool is_step(const Edge& edge);
  void add_poses(PoseGraph<Pose>& graph) const;

  std::vector<Edge> edges_;
  std::map<VertexId, Pose> poses_;
  std::vector<VertexId> posed_;
  std::vector<VertexId> fixed_;
  std::set<VertexId> ids_;
  std::map<VertexId, Step> steps_;
  std::map<std::pair<VertexId, VertexId>, std::vector<Index>> between_;
};

extern template class EdgeLog<Pose2>;
extern template class EdgeLog<Pose3>;

}  // namespace isotherm::slam::detail
