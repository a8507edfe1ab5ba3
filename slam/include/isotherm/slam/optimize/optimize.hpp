#pragma once

#include <array>
#include <concepts>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/any_pose_graph.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/optimize/initialize.hpp"
#include "isotherm/slam/optimize/robust_kernel.hpp"

namespace isotherm::slam {

/// How a step is chosen from the normal equations.
enum class OptimizeAlgorithm {
  automatic,  ///< Gauss-Newton for the kernels cauchy, dcs and sc, else Levenberg-Marquardt
  /// Full steps, downhill or not. From odometry it reaches optima that damped
  /// steps miss, and kernels that level off (DCS) need it; it may diverge.
  gauss_newton,
  /// Only steps that lower the cost (H. Nielsen's damping, 1999).
  levenberg_marquardt,
};

constexpr std::array<EnumName<OptimizeAlgorithm>, 3> enum_names(OptimizeAlgorithm) {
  return {{{OptimizeAlgorithm::automatic, "automatic"},
           {OptimizeAlgorithm::gauss_newton, "gauss-newton"},
           {OptimizeAlgorithm::levenberg_marquardt, "levenberg-marquardt"}}};
}

struct OptimizeOptions {
  RobustKernel kernel = RobustKernel::none;
  double kernel_width = 0.0;  ///< see evaluate_kernel(); 0: default_kernel_width()
  /// Apply the kernel to odometry too. The robust methods trust odometry.
  bool kernel_on_odometry = false;
  /// The spanning tree starts closest on clean graphs; against false loops use
  /// odometry, which no false loop can bend, or switchable.
  Initialization initialization = Initialization::automatic;
  OptimizeAlgorithm algorithm = OptimizeAlgorithm::automatic;
  int max_iterations = 100;  ///< accepted and rejected steps, >= 0
  /// Converged where what an undamped step promises to gain (Newton's decrement) is less than
  /// this fraction of the cost; in (0, 1].
  double cost_tolerance = 1e-6;

  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, OptimizeOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("kernel", options.kernel, "robust kernel on loop closures");
  visit("kernel_width", options.kernel_width,
        "in sqrt(chi2) for huber and cauchy, else in chi2; 0: the kernel's own default",
        closed(0, 1e12));
  visit("kernel_on_odometry", options.kernel_on_odometry, "apply the kernel to odometry too");
  visit("initialization", options.initialization, "where to start");
  visit("algorithm", options.algorithm, "how steps are chosen");
  visit("max_iterations", options.max_iterations, "give up after this many steps", closed(0, 1e6));
  visit("cost_tolerance", options.cost_tolerance, "fraction of the cost left to gain that ends it",
        left_open(0, 1));
}

enum class OptimizeStatus {
  converged,
  iteration_limit,  ///< the poses are the best seen, but not an optimum
  diverged,         ///< the cost left the range of numbers; the poses are the best seen
};

constexpr std::array<EnumName<OptimizeStatus>, 3> enum_names(OptimizeStatus) {
  return {{{OptimizeStatus::converged, "converged"},
           {OptimizeStatus::iteration_limit, "iteration-limit"},
           {OptimizeStatus::diverged, "diverged"}}};
}

/// How well an optimisation went.
struct OptimizeSummary {
  OptimizeStatus status = OptimizeStatus::converged;
  int iterations = 0;         ///< steps tried
  double initial_cost = 0.0;  ///< sum of kernel costs at the start; chi-squared without a kernel
  double final_cost = 0.0;
  Eigen::VectorXd chi2;     ///< r' Omega r a constraint at the poses found, without the kernel
  Eigen::VectorXd weight;   ///< the kernel's weight a constraint, 1 without a kernel
  Index components = 0;     ///< connected components, each with its own gauge
  std::vector<Index> held;  ///< vertices that were not moved: the gauge
  Index projected_information = 0;  ///< information matrices with a negative eigenvalue
  /// Constraints that repeat another one to the last digit: it counts for them, their own
  /// chi2 is 0.
  Index repeats = 0;
  double seconds = 0.0;  ///< wall clock
};

/// What an optimisation found, and how well.
template <class Pose>
struct OptimizeResult : OptimizeSummary {
  std::vector<Pose> poses;  ///< T_world_vertex, one a vertex
};

/// The same where the type of the poses is not known.
struct OptimizedGraph : OptimizeSummary {
  AnyPoseGraph graph;  ///< with the poses found
};

/// Finds the poses with the least sum of (robust) chi-squared over all constraints,
/// sum of rho(r' Omega r) with r = log(T_from_to^-1 T_from^-1 T_to).
///
/// Sparse normal equations with Cholesky factorisation (CHOLMOD), analytic
/// Jacobians on the Lie group, full information matrices. Time is that of the
/// factorisations: about 0.06 s each for 10,000 poses of a city.
///
/// Defined for every graph: the gauge is fixed once a connected component (at the
/// vertices the graph fixes, or else at the first); poses without constraints do
/// not move; a constraint from a vertex to itself counts in the cost and moves
/// nothing; zero information neither joins nor moves anything; directions that
/// nothing measures stay where the initialisation put them; eigenvalues of
/// information below zero count as zero and are reported. An empty graph has
/// an empty result.
/// Progress is one unit an iteration; the number of threads plays no part.
/// @throws InvalidArgument for bad options, a vertex index out of range, an entry
///   that is not finite, or `file` initialisation without poses; Cancelled.
template <class Pose>
OptimizeResult<Pose> optimize(const PoseGraph<Pose>& graph, const OptimizeOptions& options = {},
                              const RunContext& run = {});
OptimizedGraph optimize(const AnyPoseGraph& graph, const OptimizeOptions& options = {},
                        const RunContext& run = {});

/// The same with given roles: the kernel applies to roles.candidates.
template <class Pose>
OptimizeResult<Pose> optimize(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                              const OptimizeOptions& options, const RunContext& run = {});

}  // namespace isotherm::slam
