#pragma once

#include <vector>

#include "optimize/minimize.hpp"

namespace isotherm::slam::detail {

/// Switchable constraints (Suenderhauf and Protzel 2012): every constraint in
/// `robust` has a switch s in [0, 1], and poses and switches together minimise
///
///     sum of s^2 chi2 + width (1 - s)^2.
///
/// A switch meets one constraint only, so it is eliminated from each Gauss-Newton
/// step exactly and the system stays as small as without switches. They start at
/// 1. On return `weights` holds s^2, and 1 for the other constraints.
template <class Pose>
MinimizeSummary minimize_switchable(NormalEquations<Pose>& equations,
                                    const std::vector<bool>& robust, double width,
                                    const MinimizeOptions& options, std::vector<Pose>& poses,
                                    Eigen::VectorXd& weights);

/// Graduated non-convexity (Yang et al. 2020): truncated least squares, or
/// Geman-McClure with `truncated` false, over the constraints in `robust`; the
/// others keep weight 1. The surrogate's mu changes by a factor of 1.4 a round
/// (the paper's), from what is convex enough for the largest chi-squared at the given
/// poses or for 5,000 widths. Every round starts from the given poses: where false
/// loops have bent the map is a poor place to start from.
template <class Pose>
MinimizeSummary minimize_graduated(NormalEquations<Pose>& equations,
                                   const std::vector<bool>& robust, double width, bool truncated,
                                   const MinimizeOptions& options, std::vector<Pose>& poses,
                                   Eigen::VectorXd& weights);

/// The optimum of switchable constraints of the given width over the candidates, from
/// odometry; odometry where that diverges.
/// @throws InvalidArgument as initial_poses(), Cancelled
template <class Pose>
std::vector<Pose> switchable_poses(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                   double width, const ProgressCallback& progress = {});

}  // namespace isotherm::slam::detail
