#pragma once

#include <vector>

namespace isotherm::slam::detail {

/// The factor on all covariances under which short cycles miss by as much as they should,
/// or 1 if there are too few to tell. `chi2`, of `dof` degrees of freedom, is that with
/// which a loop and two short pieces of odometry predict another (compare()).
///
/// Where the cycles fall into two crowds on a logarithmic scale, only the lower one
/// counts: those of false loops miss by far, and with many false loops they are most.
/// Matches a low quantile, since cycles of false loops that are left make the answer larger,
/// but hardly smaller. Cycles that close to rounding are left out: one of their loops is a
/// copy of the other. O(n log n) for n cycles.
double cycle_scale(std::vector<double> chi2, int dof);

}  // namespace isotherm::slam::detail
