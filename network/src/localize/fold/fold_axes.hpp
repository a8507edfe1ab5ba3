#pragma once

#include <vector>

#include "localize/evidence/evidence.hpp"
#include "localize/fold/part_move.hpp"
#include "localize/problem/map_task.hpp"

namespace isotherm::network::detail {

/// A part of a map in the plane that may be its own mirror image.
struct Fold {
  std::vector<Index> part;  ///< ascending, without anchors
  Point through;            ///< a point of the axis
  Point normal;             ///< of the axis, of length 1
  double cost = 0.0;        ///< by how much the mirrored part fits worse before anything gives way

  Point mirrored(const Point& point) const;

  /// The part in its mirror image.
  PartMove move(const Placement& placement) const;
};

/// The parts of at most 200 placed nodes that a line through two nodes with a range may be a hinge
/// of: reflected in it, they break few of the trusted pairs that tie them to the others, or
/// stretch them little. A part is grown from two of its nodes over pairs that the fold would break
/// and takes in nodes that two such pairs lead to, so that no single range, which may be
/// false, joins what is on both sides of a hinge. Each part once, and of parts that are nearly the
/// same two; the cheapest fold first. Empty in space. Only lines that begin at a node in `among`
/// count: those near what has changed since the last search. O(pairs * 200 * degree) at most, in
/// parallel.
std::vector<Fold> find_folds(const MapTask& task, const Evidence& evidence,
                             const Placement& placement, const std::vector<bool>& among);

}  // namespace isotherm::network::detail
