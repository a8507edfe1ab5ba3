#pragma once

#include <string>
#include <vector>

#include "command.hpp"
#include "isotherm/base/read_report.hpp"
#include "isotherm/slam/graph/diagnose.hpp"
#include "isotherm/slam/graph/trajectory.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"

namespace isotherm::apps {

/// Says on stderr what was repaired, noted or skipped, a line a kind.
void warn_of(const ReadReport& report, const CommonFlags& flags);

/// Reads a pose graph, from one file or several, and says on stderr what was repaired or
/// skipped, and, of several, what they make together.
/// @throws FileError, ParseError
slam::PoseGraphFile read_input_graph(const std::vector<std::string>& paths,
                                     const CommonFlags& flags);

/// The positional argument that names them.
void add_graph_inputs(CLI::App& verb, std::vector<std::string>& paths, const std::string& help);

/// What the edges are: as the file of --trusted says, or, where there is none, as edge_roles()
/// does.
/// @throws FileError, ParseError
template <class Pose>
slam::EdgeRoles roles_of(const slam::PoseGraph<Pose>& graph, const std::string& trusted);

/// Warns of what is to be doubted about the graph as a whole before it is used, and gives all
/// of it back.
template <class Pose>
std::vector<slam::Doubt> warn_of_doubts(const slam::PoseGraph<Pose>& graph,
                                        const slam::EdgeRoles& roles, const CommonFlags& flags);

/// Warns that a format which needs times has those of none, if that is so.
void warn_of_missing_times(const slam::AnyTrajectory& trajectory, slam::FileFormat format,
                           const CommonFlags& flags);

/// "robots a (110 poses), b (95 poses)"; empty if there is but one.
std::string robots_in_words(const slam::PoseGraphFile& file);

}  // namespace isotherm::apps
