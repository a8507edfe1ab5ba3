#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "isotherm/network/localize/localize.hpp"
#include "isotherm/network/range_network.hpp"
#include "isotherm/slam/graph/range_graph.hpp"
#include "isotherm/slam/ranges/locate.hpp"
#include "option_flags.hpp"

namespace isotherm::apps {

/// What `localize` is given where robots move among the nodes.
struct RobotInput {
  slam::AnyRangeGraph graph;
  std::string anchors;        ///< file of known positions, or empty
  bool file_anchors = false;  ///< points with a position in the input are known
};

/// What came of it, as of a network, and what only robots have.
struct RobotOutcome {
  network::RangeNetwork network;
  network::LocalizeResult result;
  slam::RangeErrors errors;
  Json summary;  ///< what was used and what was learned
};

/// The graph of robots that an input holds, or nothing if it holds no odometry. Of `odometry`, if
/// that is not empty, with the ranges of the input, matched by time.
/// @throws FileError, ParseError, InvalidArgument
std::optional<slam::AnyRangeGraph> read_robots(const std::string& path, const std::string& text,
                                               const std::string& odometry,
                                               const CommonFlags& flags);

/// Locates robots and beacons, says what was used and what was learned, and writes a trajectory a
/// robot unless `trajectory` is empty.
RobotOutcome locate_robots(const RobotInput& input, const slam::LocateOptions& options,
                           const std::string& trajectory, const CommonFlags& flags);

}  // namespace isotherm::apps
