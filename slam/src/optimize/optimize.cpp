#include "isotherm/slam/optimize/optimize.hpp"

#include <chrono>
#include <cmath>

#include "isotherm/base/error.hpp"
#include "optimize/minimize.hpp"
#include "optimize/robust_minimize.hpp"

namespace isotherm::slam {
namespace {

Initialization default_start(RobustKernel kernel) {
  switch (kernel) {
    case RobustKernel::none:
      return Initialization::automatic;  // see starting_poses()
    case RobustKernel::gnc:
    case RobustKernel::gnc_gm:
      return Initialization::switchable;
    default:
      return Initialization::odometry;
  }
}

bool levels_off(RobustKernel kernel) {
  return kernel == RobustKernel::cauchy || kernel == RobustKernel::dcs ||
         kernel == RobustKernel::sc;
}

// What the automatic choices stand for.
OptimizeOptions resolve(OptimizeOptions options, int dof) {
  if (options.kernel_width == 0.0) {
    options.kernel_width = default_kernel_width(options.kernel, dof);
  }
  if (options.algorithm == OptimizeAlgorithm::automatic) {
    options.algorithm = levels_off(options.kernel) ? OptimizeAlgorithm::gauss_newton
                                                   : OptimizeAlgorithm::levenberg_marquardt;
  }
  if (options.initialization == Initialization::automatic) {
    options.initialization = default_start(options.kernel);
  }
  return options;
}

// Least squares has no odometry to lean on: it starts at the chordal relaxation, or at
// the spanning tree where that costs less, as it may where loops are false.
template <class Pose>
std::vector<Pose> starting_poses(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                 Initialization method,
                                 const detail::NormalEquations<Pose>& equations,
                                 const ProgressCallback& progress) {
  if (method == Initialization::switchable) {  // as long a work as what follows
    const double width = default_kernel_width(RobustKernel::sc, Pose::kDof);
    return detail::switchable_poses(graph, roles, width, progress);
  }
  if (method != Initialization::automatic) return initial_poses(graph, roles, method);
  auto tree = initial_poses(graph, roles, Initialization::spanning_tree);
  std::vector<Pose> chordal;
  try {
    chordal = initial_poses(graph, roles, Initialization::chordal);
  } catch (const NumericalError&) {
    return tree;  // information over too many decades for a linear system
  }
  return equations.chi2(chordal).sum() < equations.chi2(tree).sum() ? chordal : tree;
}

// Runs the method of the kernel; leaves the weights it ended with.
template <class Pose>
detail::MinimizeSummary minimize_by_kernel(detail::NormalEquations<Pose>& equations,
                                           const std::vector<bool>& robust,
                                           const OptimizeOptions& options, const RunContext& run,
                                           std::vector<Pose>& poses, Eigen::VectorXd& weights) {
  const detail::MinimizeOptions minimize_options{options.algorithm, options.max_iterations,
                                                 options.cost_tolerance, run.progress};
  switch (options.kernel) {
    case RobustKernel::sc:
      return detail::minimize_switchable(equations, robust, options.kernel_width, minimize_options,
                                         poses, weights);
    case RobustKernel::gnc:
    case RobustKernel::gnc_gm:
      return detail::minimize_graduated(equations, robust, options.kernel_width,
                                        options.kernel == RobustKernel::gnc, minimize_options,
                                        poses, weights);
    default:
      break;
  }
  const detail::EdgeCost edge_cost = [&](Index k, double chi2) {
    const auto kernel = robust[k] ? options.kernel : RobustKernel::none;
    return evaluate_kernel(kernel, options.kernel_width, chi2);
  };
  const auto summary = detail::minimize(equations, edge_cost, minimize_options, poses);
  const Eigen::VectorXd chi2 = equations.chi2(poses);
  weights.resize(chi2.size());
  for (Index k = 0; k < chi2.size(); ++k) weights[k] = edge_cost(k, chi2[k]).weight;
  return summary;
}

}  // namespace

void OptimizeOptions::validate() const { require_fields_in_range(*this); }

template <class Pose>
OptimizeResult<Pose> optimize(const PoseGraph<Pose>& graph, const OptimizeOptions& options,
                              const RunContext& run) {
  return optimize(graph, edge_roles(graph), options, run);
}

OptimizedGraph optimize(const AnyPoseGraph& any, const OptimizeOptions& options,
                        const RunContext& run) {
  return std::visit(
      [&](const auto& graph) {
        auto result = optimize(graph, options, run);
        auto optimized = graph;
        optimized.poses = std::move(result.poses);
        return OptimizedGraph{std::move(result), std::move(optimized)};
      },
      any);
}

template <class Pose>
OptimizeResult<Pose> optimize(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                              const OptimizeOptions& given, const RunContext& run) {
  given.validate();
  const auto start = std::chrono::steady_clock::now();
  const OptimizeOptions options = resolve(given, Pose::kDof);
  const detail::PreparedGraph<Pose> prepared = detail::prepare(graph);
  std::vector<bool> robust(graph.constraints.size(), options.kernel_on_odometry);
  for (const Index k : roles.candidates) robust[k] = true;

  OptimizeResult<Pose> result;
  detail::NormalEquations<Pose> equations(prepared.graph);
  result.poses =
      starting_poses(prepared.graph, roles, options.initialization, equations, run.progress);
  const auto summary =
      minimize_by_kernel(equations, robust, options, run, result.poses, result.weight);

  result.status = summary.status;
  result.iterations = summary.iterations;
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  result.chi2 = equations.chi2(result.poses);
  result.components = equations.gauge().component_count;
  result.held = equations.gauge().held;
  result.projected_information = prepared.projected_information;
  result.repeats = prepared.repeats;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

template OptimizeResult<Pose2> optimize(const PoseGraph<Pose2>&, const OptimizeOptions&,
                                        const RunContext&);
template OptimizeResult<Pose3> optimize(const PoseGraph<Pose3>&, const OptimizeOptions&,
                                        const RunContext&);
template OptimizeResult<Pose2> optimize(const PoseGraph<Pose2>&, const EdgeRoles&,
                                        const OptimizeOptions&, const RunContext&);
template OptimizeResult<Pose3> optimize(const PoseGraph<Pose3>&, const EdgeRoles&,
                                        const OptimizeOptions&, const RunContext&);

}  // namespace isotherm::slam
