#pragma once

#include <Eigen/Core>

#include "isotherm/base/progress.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

/// Graphs that join points to those near them. Their edges have weight 1 and no
/// parallels, and come in ascending order of (from, to), from < to.
namespace isotherm::geometry {

struct NeighbourGraphOptions {
  int threads = 0;  ///< 0: all cores; results do not depend on it
  ProgressCallback progress = {};

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

/// Joins each point (a column of `points`, any dimension) to the `neighbours`
/// points nearest to it, so that a vertex has that degree or more; all others if
/// there are no more. Of equally far points the one with the lower number wins,
/// but for more than 16 that are equally far.
///
/// A k-d tree (nanoflann): O(n log n) for evenly spread points in few dimensions.
/// @throws InvalidArgument unless neighbours >= 1 and all coordinates are finite and
///   at most 1e150 in size; Cancelled.
spectral::WeightedGraph nearest_neighbour_graph(const Eigen::MatrixXd& points, int neighbours,
                                                const NeighbourGraphOptions& options = {});

/// Joins points at most `radius` (in the unit of the coordinates) from each other.
///
/// Memory is proportional to the edges, of which a wide radius gives n (n - 1) / 2.
/// @throws InvalidArgument unless radius is finite and > 0 and all coordinates are
///   finite and at most 1e150 in size, or if there are more edges than an Index
///   counts; Cancelled.
spectral::WeightedGraph radius_graph(const Eigen::MatrixXd& points, double radius,
                                     const NeighbourGraphOptions& options = {});

}  // namespace isotherm::geometry
