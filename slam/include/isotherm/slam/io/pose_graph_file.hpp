#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/slam/graph/any_pose_graph.hpp"
#include "isotherm/slam/io/file_format.hpp"

namespace isotherm::slam {

/// A pose graph as a file has it.
///
/// Values are those of the file to the last bit, except for the repairs that the
/// report lists: quaternions are normalised, angles wrapped to [-pi, pi],
/// information matrices that are not positive semi-definite replaced by that of
/// the edge of the same kind (odometry or candidate) whose determinant is the
/// median. `poses` is empty if the file has no vertex lines; if it has some, the
/// other vertices are placed by chaining measurements from them.
struct PoseGraphFile {
  AnyPoseGraph graph;
  ReadReport report;
  /// Comments and records of kinds this library does not know, as they stand.
  std::vector<std::string> other_lines;
  std::vector<std::string> paths;  ///< of the files that it was read from
  /// Whether each constraint is true, where a file says so (IRL, JRL); else empty.
  std::vector<bool> correct = {};
  /// The true poses, without constraints, where a file has them (JRL).
  std::optional<AnyPoseGraph> truth = {};

  // A file is its graph where a graph is asked for.
  operator const AnyPoseGraph&() const& { return graph; }
  operator AnyPoseGraph&() & { return graph; }
  operator AnyPoseGraph&&() && { return std::move(graph); }
};

/// Reads a pose graph, telling the format by its content: g2o with SE2 or
/// SE3:QUAT records, TORO, the poses of a PyFG file, whose names become GTSAM
/// keys, IRL, JRL, or libRSF's velocities and recognised places. `path` may be "-" for standard
/// input, and compressed.
///
/// One pass; memory is a small multiple of the graph's.
/// @throws FileError if the file cannot be read, ParseError if it is malformed,
///   empty, holds poses of both dimensions, or needs a repair and
///   `options.strict` is set.
PoseGraphFile read_pose_graph(const std::string& path, const ReadOptions& options = {});

/// Reads several files as one graph, in their order: vertices of the same id are the same
/// pose, that of the first file which has a line for it; a constraint that repeats another
/// one to the last digit (see exact_repeats()) is left out and noted. Where ids have no
/// letters, each file with vertices of its own is a robot (PoseGraph::robots).
/// @throws as read_pose_graph(), and ParseError for files without ids or poses of different
///   dimensions
PoseGraphFile read_pose_graphs(const std::vector<std::string>& paths,
                               const ReadOptions& options = {});

/// A robot and how many vertices are its own.
struct Robot {
  std::string name;  ///< the letter of GTSAM's keys, or the name of the file without suffix
  std::uint64_t vertices = 0;
  std::uint64_t number = 0;  ///< PoseGraph::robot() of its vertices
};

/// The robots of a graph, in the order of their first vertices; empty where ids and files
/// name none.
std::vector<Robot> robots_of(const PoseGraphFile& file);

/// The same from a reader that stands at the start of its input.
PoseGraphFile read_pose_graph(TextReader& reader, const ReadOptions& options = {});

/// The same where the format is known from detect_format().
PoseGraphFile read_pose_graph(TextReader& reader, FileFormat format,
                              const ReadOptions& options = {});

/// Writes g2o: vertices in order of id, FIX lines, constraints in their order,
/// numbers with the fewest digits that read back to the same value. `path` may be
/// "-" for standard output; a name in ".gz" is compressed. The file appears whole
/// or not at all.
/// @throws FileError if it cannot be written, InvalidArgument if a value is not
///   finite or `poses` is neither empty nor one an id.
void write_g2o(const std::string& path, const PoseGraph<Pose2>& graph);
void write_g2o(const std::string& path, const PoseGraph<Pose3>& graph);
void write_g2o(const std::string& path, const AnyPoseGraph& graph);

/// The same, with the other lines of the file at the end.
void write_g2o(const std::string& path, const PoseGraphFile& file);

/// Writes TORO: VERTEX2 and EDGE2, or VERTEX3 and EDGE3 with Euler angles. The
/// format has no FIX lines. Errors as in write_g2o.
void write_toro(const std::string& path, const AnyPoseGraph& graph);

}  // namespace isotherm::slam
