#include "optimize/minimize.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

// Damping is relative to the Hessian's diagonal. Long chains have directions
// 10^-7 as stiff as that: up to kNegligibleDamping steps are those of Gauss-Newton.
constexpr double kFirstDamping = 1e-10;
constexpr double kNegligibleDamping = 1e-9;
constexpr double kLargestDamping = 1e12;
// Chi-squared that nothing but rounding leaves: noise of one standard deviation
// in a single measurement is 1.
constexpr double kNoCost = 1e-12;

double total_cost(const EdgeCost& edge_cost, const Eigen::VectorXd& chi2) {
  double sum = 0.0;
  for (Index k = 0; k < chi2.size(); ++k) sum += edge_cost(k, chi2[k]).cost;
  return sum;
}

// Diagonal of the Hessian, with a floor for directions that nothing measures.
Eigen::VectorXd damping_scale(const spectral::BlockCholesky& hessian) {
  const Eigen::VectorXd diagonal = hessian.diagonal();
  const double largest = diagonal.size() > 0 ? diagonal.maxCoeff() : 0.0;
  return diagonal.cwiseMax(largest > 0.0 ? 1e-12 * largest : 1.0);
}

template <class Pose>
class Minimizer {
 public:
  Minimizer(NormalEquations<Pose>& equations, const EdgeCost& edge_cost,
            const MinimizeOptions& options, std::vector<Pose>& poses)
      : equations_(equations), edge_cost_(edge_cost), options_(options), poses_(poses) {}

  MinimizeSummary run() {
    summary_.initial_cost = cost_ = linearize();
    if (!std::isfinite(cost_)) {
      summary_.status = OptimizeStatus::diverged;
    } else if (equations_.gauge().variable_count > 0) {
      summary_.status = options_.algorithm == OptimizeAlgorithm::gauss_newton
                            ? gauss_newton()
                            : levenberg_marquardt();
    }
    summary_.final_cost = cost_;
    return summary_;
  }

 private:
  double linearize() {
    const auto scaling = [this](Index k, double chi2) {
      const double weight = edge_cost_(k, chi2).weight;
      return EdgeScaling{weight, weight, 0.0};
    };
    return total_cost(edge_cost_, equations_.linearize(poses_, scaling));
  }

  bool negligible(double change) const {
    return change <= std::max(options_.cost_tolerance * cost_, kNoCost);
  }

  // Decreases that keep the ratio of the last two would sum to this much more.
  // The first step has no ratio and does not end it.
  double remaining_decrease(double decrease) {
    const double ratio = std::abs(decrease) / std::exchange(last_decrease_, std::abs(decrease));
    return ratio < 1.0 ? std::abs(decrease) * ratio / (1.0 - ratio) : std::abs(decrease);
  }

  OptimizeStatus gauss_newton() {
    std::vector<Pose> best_poses = poses_;
    double best_cost = cost_;
    auto status = OptimizeStatus::iteration_limit;
    while (summary_.iterations < options_.max_iterations) {
      report_progress(options_, summary_.iterations++);
      const Eigen::VectorXd step = gauss_newton_step(equations_);
      const double promised = -step.dot(equations_.gradient());
      equations_.retract(step, poses_);
      const double previous = cost_;
      cost_ = linearize();
      if (!std::isfinite(cost_)) {
        status = OptimizeStatus::diverged;
        break;
      }
      if (cost_ < best_cost) {
        best_cost = cost_;
        best_poses = poses_;
      }
      if (negligible(promised) || negligible(remaining_decrease(previous - cost_))) {
        status = OptimizeStatus::converged;
        break;
      }
    }
    if (best_cost < cost_ || !std::isfinite(cost_)) {
      cost_ = best_cost;
      poses_ = std::move(best_poses);
    }
    return status;
  }

  OptimizeStatus levenberg_marquardt() {
    double damping = kFirstDamping;
    double growth = 2.0;
    Eigen::VectorXd scale = damping_scale(equations_.hessian());
    while (summary_.iterations < options_.max_iterations) {
      report_progress(options_, summary_.iterations++);
      double gain = -1.0;  // achieved decrease over promised decrease
      if (equations_.hessian().factorise(damping * scale)) {
        const Eigen::VectorXd step = equations_.hessian().solve(-equations_.gradient());
        const double promised =
            damping * step.dot(scale.cwiseProduct(step)) - step.dot(equations_.gradient());
        std::vector<Pose> candidate = poses_;
        equations_.retract(step, candidate);
        const double cost = total_cost(edge_cost_, equations_.chi2(candidate));
        const double decrease = cost_ - cost;
        if (decrease > 0.0) {
          gain = decrease / promised;
          poses_ = std::move(candidate);
          const double remaining = remaining_decrease(decrease);
          const bool done = negligible(promised) ||
                            negligible(damping <= kNegligibleDamping ? remaining : decrease);
          cost_ = cost;
          if (done) return OptimizeStatus::converged;
          linearize();
          scale = damping_scale(equations_.hessian());
        } else if (negligible(promised)) {
          return OptimizeStatus::converged;
        }
      }
      if (gain > 0.0) {
        damping *= std::max(0.1, 1.0 - std::pow(2.0 * gain - 1.0, 3));
        growth = 2.0;
      } else {
        damping *= growth;
        growth *= 2.0;
        if (damping > kLargestDamping) return OptimizeStatus::diverged;
      }
    }
    return OptimizeStatus::iteration_limit;
  }

  NormalEquations<Pose>& equations_;
  const EdgeCost& edge_cost_;
  const MinimizeOptions& options_;
  std::vector<Pose>& poses_;
  MinimizeSummary summary_;
  double cost_ = 0.0;
  double last_decrease_ = 0.0;  // of the step before
};

}  // namespace

void report_progress(const MinimizeOptions& options, int iteration) {
  if (!options.progress) return;
  if (!options.progress({"optimize", static_cast<std::uint64_t>(iteration),
                         static_cast<std::uint64_t>(options.max_iterations)})) {
    throw Cancelled();
  }
}

template <class Pose>
Eigen::VectorXd gauss_newton_step(NormalEquations<Pose>& equations) {
  spectral::BlockCholesky& hessian = equations.hessian();
  bool definite = hessian.factorise();
  if (!definite) {
    const Eigen::VectorXd scale = damping_scale(hessian);
    for (double damping = 1e-12; !definite && damping <= 1.0; damping *= 100.0) {
      definite = hessian.factorise(damping * scale);
    }
  }
  if (!definite) throw NumericalError("gauss-newton", "the normal equations are not definite");
  return hessian.solve(-equations.gradient());
}

template <class Pose>
MinimizeSummary minimize(NormalEquations<Pose>& equations, const EdgeCost& edge_cost,
                         const MinimizeOptions& options, std::vector<Pose>& poses) {
  return Minimizer<Pose>(equations, edge_cost, options, poses).run();
}

template Eigen::VectorXd gauss_newton_step(NormalEquations<Pose2>&);
template Eigen::VectorXd gauss_newton_step(NormalEquations<Pose3>&);
template MinimizeSummary minimize(NormalEquations<Pose2>&, const EdgeCost&, const MinimizeOptions&,
                                  std::vector<Pose2>&);
template MinimizeSummary minimize(NormalEquations<Pose3>&, const EdgeCost&, const MinimizeOptions&,
                                  std::vector<Pose3>&);

}  // namespace isotherm::slam
