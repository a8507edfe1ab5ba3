#pragma once

#include <string>

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/slam/graph/range_graph.hpp"

namespace isotherm::slam {

/// Odometry and ranges as a file has them.
struct RangeGraphFile {
  AnyRangeGraph graph;
  ReadReport report;
};

/// Reads odometry and ranges, telling the format by its content:
/// - PyFG: VERTEX_SE2, VERTEX_SE3:QUAT, VERTEX_XY, VERTEX_XYZ, the same with :PRIOR, EDGE_SE2,
///   EDGE_SE3:QUAT and EDGE_RANGE lines;
/// - libRSF: `odom2diff` lines, a step each that ends at its time stamp, and `range2` lines of the
///   same time stamps. The pose at the k-th time, from 0, is called `k`.
///
/// Records of other kinds are counted in `report.skipped`. A file without steps is no error: its
/// graph has none.
/// @throws FileError if the file cannot be read, ParseError if it is malformed: a covariance that
/// is
///   not positive definite, a range of a node to itself, a node that is given twice, a range of a
///   time without odometry
RangeGraphFile read_range_graph(const std::string& path, const ReadOptions& options = {});

/// The same from a reader that stands at the start of its input.
RangeGraphFile read_range_graph(TextReader& reader, const ReadOptions& options = {});

}  // namespace isotherm::slam
