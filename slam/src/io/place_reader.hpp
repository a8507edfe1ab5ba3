#pragma once

#include "isotherm/slam/io/pose_graph_file.hpp"

namespace isotherm::slam::detail {

/// Reads libRSF's `odom2` lines (velocities) and `loop` lines (pairs of times at
/// which a place was recognised) as a planar pose graph; see docs/formats.md.
/// @throws ParseError
PoseGraphFile read_places(TextReader& text);

}  // namespace isotherm::slam::detail
