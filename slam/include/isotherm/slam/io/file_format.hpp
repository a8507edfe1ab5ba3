#pragma once

#include <array>

#include "isotherm/base/options.hpp"
#include "isotherm/base/text_reader.hpp"

namespace isotherm::slam {

/// The formats that are read and written. docs/formats.md describes each.
enum class FileFormat {
  unknown,
  g2o,
  toro,
  edge_rows,  ///< rows of from to x y theta and the information's upper triangle
  irl,        ///< riSAM's incremental robot log
  jrl,        ///< JSON robot log
  places,     ///< libRSF's `odom2` and `loop` lines: velocities and recognised places
  pyfg,
  tum,
  kitti,
  euroc,
  planar,        ///< rows of time x y theta
  points,        ///< libRSF's `point2` lines: positions without headings
  ranges,        ///< rows of from,to,range[,sigma]
  librsf,        ///< libRSF's `range2` lines
  intervals,     ///< rows of i j lower upper
  beacons,       ///< rows of time tag beacon range
  flight_times,  ///< rows of microseconds node node and radio diagnostics
  edges,         ///< rows of from to [weight]
  matrix_market,
  binary_graph,  ///< a plain graph, compact
};

constexpr std::array<EnumName<FileFormat>, 21> enum_names(FileFormat) {
  return {{{FileFormat::unknown, "unknown"},
           {FileFormat::g2o, "g2o"},
           {FileFormat::toro, "toro"},
           {FileFormat::edge_rows, "edge-rows"},
           {FileFormat::irl, "irl"},
           {FileFormat::jrl, "jrl"},
           {FileFormat::places, "places"},
           {FileFormat::pyfg, "pyfg"},
           {FileFormat::tum, "tum"},
           {FileFormat::kitti, "kitti"},
           {FileFormat::euroc, "euroc"},
           {FileFormat::planar, "planar"},
           {FileFormat::points, "points"},
           {FileFormat::ranges, "ranges"},
           {FileFormat::librsf, "librsf"},
           {FileFormat::intervals, "intervals"},
           {FileFormat::beacons, "beacons"},
           {FileFormat::flight_times, "flight-times"},
           {FileFormat::edges, "edges"},
           {FileFormat::matrix_market, "matrix-market"},
           {FileFormat::binary_graph, "binary-graph"}}};
}

/// What kind of data a file holds.
enum class FileContent { unknown, pose_graph, ranges, trajectory, graph };

/// PyFG counts as ranges; it may hold a pose graph as well.
FileContent content_of(FileFormat format);

/// Tells the format by the first records of the input, which is not consumed.
/// The name of the file plays no part.
FileFormat detect_format(TextReader& reader);

/// The same. @throws ParseError if the input is empty or in no known format.
FileFormat require_format(TextReader& reader);

}  // namespace isotherm::slam
