#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/types.hpp"

namespace isotherm::network {

using spectral::Index;

/// A measured distance between two nodes.
struct RangeMeasurement {
  Index from = 0;  ///< positions in RangeNetwork::names
  Index to = 0;
  double distance = 0.0;   ///< metres, >= 0
  double variance = 0.0;   ///< square metres; 0 where the file calls the distance exact
  double timestamp = 0.0;  ///< seconds; 0 if the file has none
  std::uint64_t line = 0;  ///< line of the input file; 0 if there is none
};

/// Nodes of a sensor network and the distances measured between them. A plain value.
struct RangeNetwork {
  int dimension = 2;                     ///< 2 or 3
  std::vector<std::string> names;        ///< as in the file, in order of appearance
  Eigen::MatrixXd positions;             ///< dimension x nodes, metres; NaN where not given
  std::vector<Index> landmarks;          ///< nodes that do not move (anchors, beacons), ascending
  std::vector<RangeMeasurement> ranges;  ///< in the order of the file

  Index node_count() const noexcept { return static_cast<Index>(names.size()); }
};

}  // namespace isotherm::network
