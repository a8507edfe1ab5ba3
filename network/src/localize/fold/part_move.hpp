#pragma once

#include <vector>

#include "localize/evidence/crowd.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/problem/map_task.hpp"

namespace isotherm::network::detail {

/// A part of a map somewhere else.
struct PartMove {
  std::vector<Index> part;    ///< placed nodes, ascending, without anchors
  Eigen::MatrixXd positions;  ///< dimension x part
};

/// Nodes of the largest part that is looked at. Without anchors a part is what turns beside the
/// rest, which is larger.
Index largest_part(const RangeProblem& problem, const Placement& placement);

/// What comes of moving it there.
struct MoveOutcome {
  std::vector<Index> moved;   ///< nodes that are elsewhere then, by more than noise; ascending
  Eigen::MatrixXd positions;  ///< dimension x moved
  /// By how much the map is worse then, in chi-squared: what ranges that fit less and absent
  /// ones cost. Negative if it is better.
  double extra = 0.0;
};

/// Moves the part, then lets it and its neighbours move to where their trusted pairs fit best
/// among all others, which stay: noise may bend a part until its mirror image fits, which
/// no motion of it as a rigid body shows. Only the part moves if the nodes around its neighbours
/// do not span space, and nothing does if even those around it do not. O(nodes of the part *
/// degree) and a few sparse factorisations of their size.
MoveOutcome try_move(const MapTask& task, const Evidence& evidence, const Crowd& crowd,
                     const Placement& placement, const PartMove& move);

/// Those of the moves by which the map gains, each tried alone; those that gain most first.
std::vector<MoveOutcome> gains(const MapTask& task, const Evidence& evidence,
                               const Placement& placement, const std::vector<PartMove>& moves);

/// Makes these moves, but of two that have a node, or neighbours, in common only the first. The
/// nodes that moved.
std::vector<Index> take_moves(const RangeProblem& problem, const std::vector<MoveOutcome>& moves,
                              Placement& placement);

}  // namespace isotherm::network::detail
