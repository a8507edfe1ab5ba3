#pragma once

#include <vector>

#include "isotherm/base/progress.hpp"
#include "ranges/range_equations.hpp"

namespace isotherm::slam::detail {

struct FitOptions {
  int max_iterations = 100;  ///< of steps, in all rounds
  ProgressCallback progress = {};
};

/// What a fit came to.
struct FitSummary {
  bool converged = false;
  int iterations = 0;
  double cost = 0.0;              ///< RangeEquations::cost()
  double evidence = 0.0;          ///< log evidence by Laplace's approximation, up to a constant
  std::vector<double> variances;  ///< of the prediction of each range
  std::vector<double> curvatures;
};

/// Moves `at` to a maximum of the joint density of poses and model: damped steps of
/// RangeEquations by turns with the most likely parameters (expectation maximisation). What errors
/// lose to the estimate, and how accurate steps are, follows from the covariances between rounds of
/// this (MacKay 1992).
/// @throws Cancelled
template <class Pose>
FitSummary fit(const RangeProblem<Pose>& problem, const FitOptions& options,
               RangeEstimate<Pose>& at);

}  // namespace isotherm::slam::detail
