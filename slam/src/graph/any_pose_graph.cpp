#include "isotherm/slam/graph/any_pose_graph.hpp"

#include <utility>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {

template <class Pose>
const PoseGraph<Pose>& as(const AnyPoseGraph& graph) {
  const auto* found = std::get_if<PoseGraph<Pose>>(&graph);
  if (found == nullptr) {
    throw InvalidArgument("graph", Pose::kDim == 2
                                       ? "its poses are in space: ask for it as one of Pose3"
                                       : "its poses are in the plane: ask for it as one of Pose2");
  }
  return *found;
}

template <class Pose>
PoseGraph<Pose>& as(AnyPoseGraph& graph) {
  return const_cast<PoseGraph<Pose>&>(as<Pose>(std::as_const(graph)));
}

template <class Pose>
PoseGraph<Pose> as(AnyPoseGraph&& graph) {
  return std::move(as<Pose>(graph));
}

template const PoseGraph<Pose2>& as(const AnyPoseGraph&);
template const PoseGraph<Pose3>& as(const AnyPoseGraph&);
template PoseGraph<Pose2>& as(AnyPoseGraph&);
template PoseGraph<Pose3>& as(AnyPoseGraph&);
template PoseGraph<Pose2> as(AnyPoseGraph&&);
template PoseGraph<Pose3> as(AnyPoseGraph&&);

}  // namespace isotherm::slam
