#pragma once

#include <limits>
#include <vector>

#include "isotherm/base/progress.hpp"
#include "isotherm/network/localize/range_mixture.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/problem/absence.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// A range between two nodes in a least-squares problem. A pair of widths, in standard
/// deviations, of Geman and McClure's loss says how far off it may be: infinite is plain least
/// squares, 0 no loss at all.
struct Spring {
  Index from = 0;
  Index to = 0;
  double distance = 0.0;
  double sigma = 1.0;
  double width_apart = std::numeric_limits<double>::infinity();  ///< ends farther than `distance`
  double width_close = std::numeric_limits<double>::infinity();  ///< ends closer than that
  bool couples = true;  ///< whether a step takes both ends together
  bool absent = false;  ///< there is none: only absence has a say
};

struct RefineOptions {
  /// Width, in standard deviations, of Geman and McClure's loss; infinite for plain
  /// least squares.
  double width = std::numeric_limits<double>::infinity();
  int max_iterations = 100;
  double still = 1e-8;  ///< relative decrease of the loss at which it ends
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

/// The same for the springs between placed nodes, which have widths of their own;
/// `options.width` does not count.
RefineOutcome refine(const RangeProblem& problem, const std::vector<Spring>& springs,
                     Placement& placement, const RefineOptions& options);

/// The same to where the springs are likeliest, by what is known of the kinds of range and of
/// absent ones.
RefineOutcome refine_likelihood(const RangeProblem& problem, const std::vector<Spring>& springs,
                                const Evidence& evidence, int max_iterations, Placement& placement);

/// Moves the placed nodes that are no anchors, and the shares and the excess of `model`, to a
/// maximum of the joint density of all ranges between placed nodes, and of there being no others:
/// damped steps and most likely parameters by turns (expectation maximisation). `too_long` says
/// whether ranges can be. @throws Cancelled
RefineOutcome refine_mixture(const RangeProblem& problem, const Absence& absence, bool too_long,
                             const LocalizeOptions& options, RangeMixture& model,
                             Placement& placement);

}  // namespace isotherm::network::detail
