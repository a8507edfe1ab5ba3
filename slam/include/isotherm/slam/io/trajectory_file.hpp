#pragma once

#include <string>
#include <vector>

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/slam/graph/trajectory.hpp"
#include "isotherm/slam/io/file_format.hpp"

namespace isotherm::slam {

/// A trajectory as a file has it.
struct TrajectoryFile {
  AnyTrajectory trajectory;
  ReadReport report;
};

/// Reads a trajectory, telling the format by its content: TUM, KITTI (with or
/// without a leading time stamp), EuRoC, rows of `time x y theta` separated by
/// blanks or commas, libRSF's `point2` and `angle` lines (headings not given
/// are 0, which is noted), or a pose graph, of which the vertices are taken (or, if it has none,
/// the chain of its odometry).
/// @throws FileError if the file cannot be read, ParseError if it is malformed,
///   empty, of no such format, or needs a repair and `options.strict` is set.
TrajectoryFile read_trajectory(const std::string& path, const ReadOptions& options = {});

/// The same from a reader that stands at the start of its input.
TrajectoryFile read_trajectory(TextReader& reader, const ReadOptions& options = {});

/// The same where the format is known from detect_format().
TrajectoryFile read_trajectory(TextReader& reader, FileFormat format,
                               const ReadOptions& options = {});

/// Reads times in seconds, one a line.
/// @throws FileError, ParseError
std::vector<double> read_timestamps(const std::string& path);

/// Writes TUM, KITTI, EuRoC or planar rows. Planar poses are lifted to z = 0
/// where the format is spatial; where it needs time stamps and there are none,
/// pose k gets stamp k.
/// @throws FileError if the file cannot be written, InvalidArgument for another
///   format, spatial poses in the planar one, values that are not finite, or a
///   number of time stamps that is neither 0 nor that of the poses.
void write_trajectory(const std::string& path, const AnyTrajectory& trajectory, FileFormat format);

}  // namespace isotherm::slam
