#pragma once

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

  // A file is its graph where a graph is asked for.
  operator const AnyPoseGraph&() const& { return graph; }
  operator AnyPoseGraph&() & { return graph; }
  operator AnyPoseGraph&&() && { return std::move(graph); }
};

/// Reads a pose graph, telling the format by its content: g2o with SE2 or
/// SE3:QUAT records, TORO, the poses of a PyFG file, whose names become GTSAM
/// keys, or libRSF's velocities and recognised places. `path` may be "-" for standard input, and
/// compressed.
///
/// One pass; memory is a small multiple of the graph's.
/// @throws FileError if the file cannot be read, ParseError if it is malformed,
///   empty, holds poses of both dimensions, or needs a repair and
///   `options.strict` is set.
PoseGraphFile read_pose_graph(const std::string& path, const ReadOptions& options = {});

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
