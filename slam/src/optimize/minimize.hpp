#pragma once

#include <functional>
#include <vector>

#include "isotherm/slam/optimize/optimize.hpp"
#include "optimize/normal_equations.hpp"

namespace isotherm::slam::detail {

/// Cost of constraint k with the given chi-squared, and its derivative.
using EdgeCost = std::function<KernelValue(Index constraint, double chi2)>;

struct MinimizeOptions {
  OptimizeAlgorithm algorithm = OptimizeAlgorithm::gauss_newton;
  int max_iterations = 100;
  double cost_tolerance = 1e-6;
  ProgressCallback progress = {};
};

struct MinimizeSummary {
  OptimizeStatus status = OptimizeStatus::converged;
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
};

/// Tells the callback. @throws Cancelled if it asks to stop.
void report_progress(const MinimizeOptions& options, int iteration);

/// Moves `poses` to a minimum of the summed edge costs, reusing the symbolic
/// factorisation of `equations`.
template <class Pose>
MinimizeSummary minimize(NormalEquations<Pose>& equations, const EdgeCost& edge_cost,
                         const MinimizeOptions& options, std::vector<Pose>& poses);

/// Factorises the Hessian, with the least damping that makes it definite.
/// Returns the undamped solution of H step = -gradient where that exists.
/// @throws NumericalError if no damping helps (values that are not finite).
template <class Pose>
Eigen::VectorXd gauss_newton_step(NormalEquations<Pose>& equations);

/// `graph` checked, with information matrices made semi-definite and those of exact repeats
/// zero.
template <class Pose>
struct PreparedGraph {
  PoseGraph<Pose> graph;
  Index projected_information = 0;  ///< how many matrices had a negative eigenvalue
  Index repeats = 0;
};

/// @throws InvalidArgument for indices out of range or entries that are not finite.
template <class Pose>
PreparedGraph<Pose> prepare(const PoseGraph<Pose>& graph);

}  // namespace isotherm::slam::detail
