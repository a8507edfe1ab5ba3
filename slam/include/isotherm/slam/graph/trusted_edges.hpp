#pragma once

#include <string>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// Roles by a list of the user's instead of by edge_roles(): what the list names is
/// trusted, every other constraint is a candidate.
///
/// The file is CSV: a column `edge` (0-based position among the edge lines), or
/// columns `from,to` (vertex ids; every constraint between the two, in either
/// direction, is trusted). Without a header, one column means `edge`, two `from,to`.
/// @throws FileError, ParseError; a row that names no constraint of the graph is a
///   ParseError
template <class Pose>
EdgeRoles read_trusted_edges(const std::string& path, const PoseGraph<Pose>& graph);

}  // namespace isotherm::slam
