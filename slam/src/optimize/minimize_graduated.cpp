#include <algorithm>
#include <cmath>

#include "optimize/robust_minimize.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kMuStep = 1.4;
constexpr int kMostRounds = 200;
// Convexity for more than a chi-squared of 10^4 widths gives false loops a hold on
// the first rounds and true ones nothing.
constexpr double kLeastMu = 1e-4;

// The surrogate of one loss at one degree of convexity mu.
struct Surrogate {
  bool truncated;
  double width;  // largest chi-squared of a good constraint
  double mu;

  // Convex enough for the largest chi-squared: remarks 5 and 6.
  void start(double largest) {
    const double ratio = std::min(largest / width, 0.5 / kLeastMu);
    mu = truncated ? 1.0 / (2.0 * ratio - 1.0) : 2.0 * ratio;
  }

  // The original loss is reached, or nothing exceeds the width in the first place.
  bool done(const Eigen::VectorXd& weights) const {
    if (!truncated) return mu <= 1.0;
    return ((weights.array() < 1e-4) || (weights.array() > 1.0 - 1e-4)).all();
  }

  void sharpen() { mu = truncated ? mu * kMuStep : std::max(1.0, mu / kMuStep); }

  // Propositions 3 (Geman-McClure) and 4 (truncated least squares).
  double weight(double chi2) const {
    if (!truncated) return std::pow(mu * width / (chi2 + mu * width), 2);
    if (chi2 >= (mu + 1.0) / mu * width) return 0.0;
    if (chi2 <= mu / (mu + 1.0) * width) return 1.0;
    return std::clamp(std::sqrt(width * mu * (mu + 1.0) / chi2) - mu, 0.0, 1.0);
  }
};

double largest_of(const Eigen::VectorXd& chi2, const std::vector<bool>& robust) {
  double largest = 0.0;
  for (Index k = 0; k < chi2.size(); ++k) {
    if (robust[k]) largest = std::max(largest, chi2[k]);
  }
  return largest;
}

// The loss itself, which the surrogates end at.
double loss(const Eigen::VectorXd& chi2, const std::vector<bool>& robust, double width,
            bool truncated) {
  const RobustKernel kernel = truncated ? RobustKernel::gnc : RobustKernel::gnc_gm;
  double sum = 0.0;
  for (Index k = 0; k < chi2.size(); ++k) {
    sum += robust[k] ? evaluate_kernel(kernel, width, chi2[k]).cost : chi2[k];
  }
  return sum;
}

}  // namespace

template <class Pose>
MinimizeSummary minimize_graduated(NormalEquations<Pose>& equations,
                                   const std::vector<bool>& robust, double width, bool truncated,
                                   const MinimizeOptions& options, std::vector<Pose>& poses,
                                   Eigen::VectorXd& weights) {
  weights = Eigen::VectorXd::Ones(equations.constraint_count());
  const EdgeCost edge_cost = [&](Index k, double chi2) {
    return KernelValue{weights[k] * chi2, weights[k]};
  };
  const std::vector<Pose> start = poses;
  Eigen::VectorXd chi2 = equations.chi2(start);
  MinimizeSummary total;
  total.initial_cost = loss(chi2, robust, width, truncated);
  total.status = OptimizeStatus::iteration_limit;
  Surrogate surrogate{truncated, width, 0.0};
  surrogate.start(std::max(largest_of(chi2, robust), width));
  for (int round = 0; round < kMostRounds; ++round) {
    for (Index k = 0; k < chi2.size(); ++k) {
      if (robust[k]) weights[k] = surrogate.weight(chi2[k]);
    }
    poses = start;
    const auto summary = minimize(equations, edge_cost, options, poses);
    chi2 = equations.chi2(poses);
    total.iterations += summary.iterations;
    if (surrogate.done(weights)) {
      total.status = summary.status;
      break;
    }
    surrogate.sharpen();
  }
  total.final_cost = loss(chi2, robust, width, truncated);
  return total;
}

template MinimizeSummary minimize_graduated(NormalEquations<Pose2>&, const std::vector<bool>&,
                                            double, bool, const MinimizeOptions&,
                                            std::vector<Pose2>&, Eigen::VectorXd&);
template MinimizeSummary minimize_graduated(NormalEquations<Pose3>&, const std::vector<bool>&,
                                            double, bool, const MinimizeOptions&,
                                            std::vector<Pose3>&, Eigen::VectorXd&);

}  // namespace isotherm::slam::detail
