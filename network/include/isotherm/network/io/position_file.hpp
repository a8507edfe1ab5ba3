#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "isotherm/network/localize/localize.hpp"
#include "isotherm/network/range_network.hpp"

namespace isotherm::network {

/// Positions by the name of the node.
struct NamedPositions {
  std::vector<std::string> names;
  Eigen::MatrixXd positions;  ///< dimension x names, metres

  int dimension() const { return static_cast<int>(positions.rows()); }

  /// Which column of `positions` belongs to a name.
  std::unordered_map<std::string, Eigen::Index> column_of() const;
};

/// Reads `node,x,y[,z]` rows, with or without column names; other columns are
/// ignored. Rows whose `status` column (if any) is neither `anchor` nor `localised`
/// have no position and are left out.
/// @throws FileError; ParseError for a malformed or empty file or a node given twice.
NamedPositions read_positions(const std::string& path);

/// Writes `node,x,y[,z]` rows below a line with these names; "-" is stdout.
/// @throws FileError
void write_positions(const std::string& path, const NamedPositions& positions);

/// Writes `node,x,y[,z],status,sigma` rows and the upper triangle of the covariance
/// (`cxx,cxy,cyy`, or `cxx,cxy,cxz,cyy,cyz,czz`), one a node in the network's order;
/// sigma is the root of the covariance's trace. Where there is no position these
/// fields are `nan`; anchors have a covariance of 0. @throws FileError
void write_positions(const std::string& path, const RangeNetwork& network,
                     const LocalizeResult& result);

/// Makes the named nodes the network's only landmarks, at these positions, and gives
/// the network their dimension. Nodes that the network lacks are added to it; their
/// names come back, for they may be misspelt.
std::vector<std::string> set_anchors(RangeNetwork& network, const NamedPositions& anchors);

}  // namespace isotherm::network
