#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "isotherm/network/range_network.hpp"
#include "isotherm/slam/graph/range_graph.hpp"
#include "isotherm/slam/graph/trajectory.hpp"
#include "isotherm/slam/ranges/locate.hpp"

namespace isotherm::slam {

/// What a log of ranges came to beside odometry.
struct AttachedRanges {
  std::int64_t attached = 0;
  std::int64_t outside = 0;  ///< left out: at a time without odometry
};

/// Replaces the graph's ranges by those of a log, in which each is between a beacon and a nameless
/// node at some time: that is the pose nearest in time. Beacons get the names that the log has.
/// @throws InvalidArgument for a graph of several robots or without time stamps, or a log without
///   time stamps
template <class Pose>
AttachedRanges attach_ranges(const network::RangeNetwork& log, RangeGraph<Pose>& graph);

/// The nodes and ranges, without what robots did between them.
template <class Pose>
network::RangeNetwork network_of(const RangeGraph<Pose>& graph);

/// The same result as that of a network.
template <class Pose>
network::LocalizeResult as_localize_result(const RangeGraph<Pose>& graph,
                                           const LocateResult<Pose>& result);

/// The poses of one robot, in order of time, as far as they have a place.
template <class Pose>
struct RobotTrajectory {
  std::string robot;  ///< what its poses' names start with: letters; may be empty
  Trajectory<Pose> trajectory;
};

/// Robots in order of appearance.
template <class Pose>
std::vector<RobotTrajectory<Pose>> robot_trajectories(const RangeGraph<Pose>& graph,
                                                      const LocateResult<Pose>& result);

}  // namespace isotherm::slam
