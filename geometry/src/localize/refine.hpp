#pragma once

#include <limits>
#include <vector>

#include "isotherm/base/progress.hpp"
#include "localize/range_problem.hpp"

namespace isotherm::geometry::detail {

struct RefineOptions {
  /// Width, in standard deviations, of Geman and McClure's loss; infinite for plain
  /// least squares.
  double width = std::numeric_limits<double>::infinity();
  int max_iterations = 100;
  ProgressCallback progress = {};
};

struct RefineOutcome {
  int iterations = 0;
  bool converged = true;
};

/// Moves the placed nodes that are no anchors to a minimum of the loss of the ranges
/// in `use` between placed nodes: reweighted Levenberg-Marquardt steps with a sparse
/// factorisation each. @throws Cancelled
RefineOutcome refine(const RangeProblem& problem, const std::vector<bool>& use,
                     Placement& placement, const RefineOptions& options);

}  // namespace isotherm::geometry::detail
