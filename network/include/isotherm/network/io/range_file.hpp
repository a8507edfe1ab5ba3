#pragma once

#include <string>

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/network/range_network.hpp"

namespace isotherm::network {

/// A range network as a file has it.
struct RangeFile {
  RangeNetwork network;
  ReadReport report;
};

/// Reads distances between nodes, telling the format by its content:
/// - PyFG: EDGE_RANGE lines, with positions from VERTEX lines;
/// - comma-separated rows with the columns `from,to,range` and optionally
///   `sigma` (metres);
/// - libRSF: `range2` lines; the moving node of measurement k is called `k`;
/// - distance intervals, `i j lower upper` a row (distance geometry's nmr): the
///   middle, with the variance of the uniform distribution;
/// - radio beacons, `time tag beacon range` a row: the tag at measurement k is
///   called `k`, beacons `L` and their number;
/// - times of flight, `microseconds node node` and diagnostics a row: distances at
///   the speed of light, delays inside the radios included.
///
/// Records of other kinds are counted in `report.skipped`.
/// @throws FileError if the file cannot be read, ParseError if it is malformed or
///   holds no range.
RangeFile read_ranges(const std::string& path, const ReadOptions& options = {});

/// The same from a reader that stands at the start of its input.
RangeFile read_ranges(TextReader& reader, const ReadOptions& options = {});

/// Writes `from,to,range,sigma` rows with column names.
/// @throws FileError if the file cannot be written.
void write_range_csv(const std::string& path, const RangeNetwork& network);

/// Writes PyFG: a VERTEX_XY or VERTEX_XYZ line for every node whose position is
/// known and an EDGE_RANGE line for every range. Names that do not start with a
/// letter get the prefix X.
/// @throws FileError if the file cannot be written.
void write_pyfg(const std::string& path, const RangeNetwork& network);

}  // namespace isotherm::network
