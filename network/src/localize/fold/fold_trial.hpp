#pragma once

#include <vector>

#include "localize/evidence/crowd.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/fold/fold_axes.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// What comes of mirroring a part of a map.
struct FoldOutcome {
  std::vector<Index> moved;   ///< nodes that are elsewhere then, by more than noise; ascending
  Eigen::MatrixXd positions;  ///< dimension x moved
  /// By how much the map is worse then, in chi-squared: what ranges that fit less and absent
  /// ones cost. Negative if it is better.
  double extra = 0.0;
};

/// Mirrors the part, then lets it and its neighbours move to where their trusted pairs fit best
/// among all others, which stay: noise may bend a part until its mirror image fits, which
/// no motion of it as a rigid body shows. Only the part moves if the nodes around its neighbours
/// do not span space, and nothing does if even those around it do not. O(nodes of the part *
/// degree) and a few sparse factorisations of their size.
FoldOutcome try_fold(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                     const Evidence& evidence, const Crowd& crowd, const Placement& placement,
                     const Fold& fold);

}  // namespace isotherm::network::detail
