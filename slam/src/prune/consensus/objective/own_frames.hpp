#pragma once

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

/// The graph with every measurement of `roles` told from that of its ends at which the errors of
/// translation and rotation depend less on each other: by log |Sigma_tt| + log |Sigma_rr| -
/// log |Sigma|, twice their mutual information. There each has a scale of its own that can be
/// learnt; told from the other end, an error in rotation is one in translation, too. A file may
/// tell it either way: what is found does not depend on that. Order and positions of the
/// constraints stay.
template <class Pose>
PoseGraph<Pose> in_own_frames(PoseGraph<Pose> graph, const EdgeRoles& roles);

/// The same of one measurement; its ends change places where it is told from the other.
template <class Pose>
Constraint<Pose> in_own_frame(const Constraint<Pose>& constraint);

}  // namespace isotherm::slam::detail
