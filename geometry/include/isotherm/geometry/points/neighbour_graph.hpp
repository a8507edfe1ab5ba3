#pragma once

#include <Eigen/Core>

#include "isotherm/base/run_context.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

/// Graphs that join points to those near them. Their edges have weight 1 and no
/// parallels, and come in ascending order of (from, to), from < to.
namespace isotherm::geometry {

/// Joins each point (a column of `points`, any dimension) to the `neighbours`
/// points nearest to it, so that a vertex has that degree or more; all others if
/// there are no more. Of equally far points the one with the lower number wins,
/// but for more than 16 that are equally far.
///
/// A k-d tree (nanoflann): O(n log n) for evenly spread points in few dimensions.
/// @throws InvalidArgument unless neighbours >= 1, run.threads >= 0 and all coordinates are
///   finite and at most 1e150 in size; Cancelled.
spectral::WeightedGraph nearest_neighbour_graph(const Eigen::MatrixXd& points, int neighbours,
                                                const RunContext& run = {});

/// Joins points at most `radius` (in the unit of the coordinates) from each other.
///
/// Memory is proportional to the edges, of which a wide radius gives n (n - 1) / 2.
/// @throws InvalidArgument unless radius is finite and > 0 and all coordinates are
///   finite and at most 1e150 in size, or if there are more edges than an Index
///   counts; Cancelled.
spectral::WeightedGraph radius_graph(const Eigen::MatrixXd& points, double radius,
                                     const RunContext& run = {});

}  // namespace isotherm::geometry
