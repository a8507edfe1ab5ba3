#pragma once

#include <string>

#include "command.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"

namespace isotherm::apps {

/// Reads a pose graph and says on stderr what was repaired or skipped.
/// @throws FileError, ParseError
slam::PoseGraphFile read_input_graph(const std::string& path, const CommonFlags& flags);

}  // namespace isotherm::apps
