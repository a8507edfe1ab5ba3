#include "optimize/minimize.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/sparse/damped_step.hpp"

namespace isotherm::slam::detail {
namespace {

// Damping is relative to the Hessian's diagonal. Long chains have directions
// 10^-7 as stiff as that: up to kNegligibleDamping steps are those of Gauss-Newton.
constexpr double kFirstDamping = 1e-10;
constexpr double kNegligibleDamping = 1e-9;
constexpr double kLargestDamping = 1e12;
// Chi-squared that nothing but rounding leaves: noise of one standard deviation
// in a single measurement is 1.
constexpr double kNoCost = 1e-12;
// Part of the cost that is lost when so many terms are summed.
constexpr double kRounding = 1e-12;

double total_cost(const EdgeCost& edge_cost, const Eigen::VectorXd& chi2) {
  double sum = 0.0;
  for (Index k = 0; k < chi2.size(); ++k) sum += edge_cost(k, chi2[k]).cost;
  return sum;
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

  // What a damped step asks for.
  std::optional<double> move(double damping) {
    if (!equations_.hessian().factorise(damping * scale_)) return std::nullopt;
    const Eigen::VectorXd step = equations_.hessian().solve(-equations_.gradient());
    before_ = poses_;
    equations_.retract(step, poses_);
    return damping * step.dot(scale_.cwiseProduct(step)) - step.dot(equations_.gradient());
  }
  double cost() const { return total_cost(edge_cost_, equations_.chi2(poses_)); }
  void take_back() { poses_ = std::move(before_); }

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

  // Newton's decrement: what the quadratic model promises of an undamped step from here.
  // Steps that are damped, or short for another reason, say nothing about how far it is:
  // on long chains with few loops most of what is left may lie in directions that are
  // hardly measured.
  bool nothing_left(double promised, double damping) {
    if (!negligible(promised)) return false;
    if (damping <= kNegligibleDamping) return true;
    return negligible(-gauss_newton_step(equations_).dot(equations_.gradient()));
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
      if (negligible(promised) && negligible(remaining_decrease(previous - cost_))) {
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
    spectral::GainDamping damping{kFirstDamping};
    scale_ = spectral::damping_scale(equations_.hessian());
    while (summary_.iterations < options_.max_iterations) {
      report_progress(options_, summary_.iterations++);
      const auto trial = spectral::try_damped_step(*this, damping.value, cost_);
      if (trial.solved && nothing_left(trial.promised, damping.value)) {
        if (trial.lower) cost_ = trial.cost;
        return OptimizeStatus::converged;
      }
      if (!trial.lower) {
        if (trial.solved && trial.promised <= kRounding * cost_) return OptimizeStatus::converged;
        damping.follow(-1.0);
        if (damping.value > kLargestDamping) return OptimizeStatus::diverged;
        continue;
      }
      const double decrease = cost_ - trial.cost;
      cost_ = trial.cost;
      linearize();
      scale_ = spectral::damping_scale(equations_.hessian());
      damping.follow(decrease / trial.promised);
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
  Eigen::VectorXd scale_;       // of the damping
  std::vector<Pose> before_;    // the step that is tried
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
  return spectral::solve_least_damped(equations.hessian(), -equations.gradient());
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

}  // namespace isotherm::slam::detail
