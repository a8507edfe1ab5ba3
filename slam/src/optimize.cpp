#include "isotherm/slam/optimize.hpp"

#include <chrono>
#include <cmath>

#include "isotherm/base/error.hpp"
#include "minimize.hpp"

namespace isotherm::slam {
namespace {

void require_positive(const char* field, double value) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw InvalidArgument(field, "must be a positive number");
  }
}

}  // namespace

void OptimizeOptions::validate() const {
  require_positive("kernel_width", kernel_width);
  require_positive("cost_tolerance", cost_tolerance);
  if (max_iterations < 0) throw InvalidArgument("max_iterations", "must not be negative");
}

template <class Pose>
OptimizeResult<Pose> optimize(const PoseGraph<Pose>& graph, const OptimizeOptions& options) {
  return optimize(graph, edge_roles(graph), options);
}

template <class Pose>
OptimizeResult<Pose> optimize(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                              const OptimizeOptions& options) {
  options.validate();
  const auto start = std::chrono::steady_clock::now();
  const PreparedGraph<Pose> prepared = prepare(graph);

  std::vector<bool> robust(graph.constraints.size(), options.kernel_on_odometry);
  for (const Index k : roles.candidates) robust[k] = true;
  const EdgeCost edge_cost = [&](Index k, double chi2) {
    const auto kernel = robust[k] ? options.kernel : RobustKernel::none;
    return evaluate_kernel(kernel, options.kernel_width, chi2);
  };

  OptimizeResult<Pose> result;
  result.poses = initial_poses(prepared.graph, roles, options.initialization);
  NormalEquations<Pose> equations(prepared.graph);
  const auto summary = minimize(
      equations, edge_cost,
      {options.algorithm, options.max_iterations, options.cost_tolerance, options.progress},
      result.poses);

  result.status = summary.status;
  result.iterations = summary.iterations;
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  result.chi2 = equations.chi2(result.poses);
  result.weight.resize(result.chi2.size());
  for (Index k = 0; k < result.chi2.size(); ++k) {
    result.weight[k] = edge_cost(k, result.chi2[k]).weight;
  }
  result.components = equations.gauge().component_count;
  result.held = equations.gauge().held;
  result.projected_information = prepared.projected_information;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

template OptimizeResult<Pose2> optimize(const PoseGraph<Pose2>&, const OptimizeOptions&);
template OptimizeResult<Pose3> optimize(const PoseGraph<Pose3>&, const OptimizeOptions&);
template OptimizeResult<Pose2> optimize(const PoseGraph<Pose2>&, const EdgeRoles&,
                                        const OptimizeOptions&);
template OptimizeResult<Pose3> optimize(const PoseGraph<Pose3>&, const EdgeRoles&,
                                        const OptimizeOptions&);

}  // namespace isotherm::slam
