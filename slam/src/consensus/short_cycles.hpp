#pragma once

#include <vector>

namespace isotherm::slam::detail {

/// The factor on all covariances under which short cycles miss by as much as they should,
/// or 1 if there are too few to tell. `chi2`, of `dof` degrees of freedom, is that with
/// which a loop and two short pieces of odometry predict another (compare()).
///
/// Matches a low quantile: the cycles of false loops miss by far, and make the answer
/// larger, but hardly smaller. Cycles that close to rounding are left out: one of their
/// loops is a copy of the other.
double cycle_scale(std::vector<double> chi2, int dof);

}  // namespace isotherm::slam::detail
