#include <algorithm>
#include <cmath>

#include "isotherm/base/error.hpp"
#include "optimize/robust_minimize.hpp"

namespace isotherm::slam::detail {
namespace {

double joint_cost(const Eigen::VectorXd& chi2, const Eigen::VectorXd& switches, double width) {
  return (switches.array().square() * chi2.array() + width * (1.0 - switches.array()).square())
      .sum();
}

}  // namespace

template <class Pose>
MinimizeSummary minimize_switchable(NormalEquations<Pose>& equations,
                                    const std::vector<bool>& robust, double width,
                                    const MinimizeOptions& options, std::vector<Pose>& poses,
                                    Eigen::VectorXd& weights) {
  Eigen::VectorXd switches = Eigen::VectorXd::Ones(equations.constraint_count());
  // With c = chi2 + width the switch's own second derivative, its elimination
  // (a Schur complement) leaves these factors.
  const auto scaling = [&](Index k, double chi2) -> EdgeScaling {
    if (!robust[k]) return {};
    const double s = switches[k];
    const double c = chi2 + width;
    return {s * width / c, s * s, s * s / c};
  };

  MinimizeSummary summary;
  summary.status = OptimizeStatus::iteration_limit;
  Eigen::VectorXd chi2 = equations.linearize(poses, scaling);
  double cost = joint_cost(chi2, switches, width);
  summary.initial_cost = cost;
  while (summary.iterations < options.max_iterations && equations.gauge().variable_count > 0) {
    report_progress(options, summary.iterations++);
    const Eigen::VectorXd step = gauss_newton_step(equations);
    const Eigen::VectorXd slopes = equations.slopes(poses, step);
    for (Index k = 0; k < equations.constraint_count(); ++k) {
      if (!robust[k]) continue;
      const double s = switches[k];
      const double change = (width * (1.0 - s) - s * chi2[k] - s * slopes[k]) / (chi2[k] + width);
      switches[k] = std::clamp(s + change, 0.0, 1.0);
    }
    equations.retract(step, poses);
    chi2 = equations.linearize(poses, scaling);
    const double previous = std::exchange(cost, joint_cost(chi2, switches, width));
    if (!std::isfinite(cost)) {
      summary.status = OptimizeStatus::diverged;
      break;
    }
    if (std::abs(previous - cost) <= options.cost_tolerance * cost) {
      summary.status = OptimizeStatus::converged;
      break;
    }
  }
  if (equations.gauge().variable_count == 0) summary.status = OptimizeStatus::converged;
  summary.final_cost = cost;
  weights = switches.cwiseAbs2();
  return summary;
}

template MinimizeSummary minimize_switchable(NormalEquations<Pose2>&, const std::vector<bool>&,
                                             double, const MinimizeOptions&, std::vector<Pose2>&,
                                             Eigen::VectorXd&);
template MinimizeSummary minimize_switchable(NormalEquations<Pose3>&, const std::vector<bool>&,
                                             double, const MinimizeOptions&, std::vector<Pose3>&,
                                             Eigen::VectorXd&);

}  // namespace isotherm::slam::detail
