#pragma once

#include <string>

#include "isotherm/network/io/range_file.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "option_flags.hpp"

/// What is in a file, as the JSON document of `isotherm info`.
namespace isotherm::apps {

Json describe(const slam::PoseGraphFile& file);
Json describe(const slam::TrajectoryFile& file);
Json describe(const network::RangeFile& file);
Json describe(const spectral::GraphFile& file);

/// The same document for people: a line a value, one level of indentation a level.
std::string to_text(const Json& description);

}  // namespace isotherm::apps
