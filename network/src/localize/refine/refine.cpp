#include "localize/refine/refine.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/sparse/damped_step.hpp"
#include "localize/problem/geman_mcclure.hpp"
#include "localize/problem/small_network.hpp"

namespace isotherm::network::detail {
namespace {

// The springs as a damped least-squares problem in the free nodes.
class SparseSystem {
 public:
  SparseSystem(const RangeProblem& problem, const std::vector<Spring>& springs,
               Placement& placement)
      : problem_(problem),
        placement_(placement),
        variable_(problem.nodes, -1),
        matrix_(pattern(springs)),
        gradient_(matrix_.size()) {}

  Eigen::Index unknowns() const { return matrix_.size(); }

  bool linearise() {
    matrix_.clear();
    gradient_.setZero();
    std::size_t pair = 0;
    for (const auto& spring : springs_) add(spring, pair);
    scale_ = matrix_.diagonal().mean();
    return scale_ > 0.0;
  }

  std::optional<double> move(double damping) {
    if (!matrix_.factorise(Eigen::VectorXd::Constant(unknowns(), damping * scale_))) {
      return std::nullopt;
    }
    step_ = matrix_.solve(-gradient_);
    before_ = placement_.positions;
    const int d = problem_.dimension;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (variable_[v] >= 0) placement_.positions.col(v) += step_.segment(variable_[v] * d, d);
    }
    return -step_.dot(gradient_);
  }

  void take_back() { placement_.positions = before_; }

  double cost() const {
    double sum = 0.0;
    for (const auto& spring : springs_) {
      const auto [slope, residual, kernel] = term(spring);
      sum += kernel.loss(residual * residual);
    }
    return sum;
  }

  double largest_step() const { return step_.size() > 0 ? step_.cwiseAbs().maxCoeff() : 0.0; }

 private:
  struct Term {
    Point slope;  // of the residual in the first end; minus that in the second
    double residual = 0.0;
    GemanMcClure kernel;
  };

  // Numbers the free nodes of the springs between placed ones.
  spectral::BlockCholesky pattern(const std::vector<Spring>& springs) {
    Index count = 0;
    std::vector<std::pair<Index, Index>> pairs;
    for (const auto& spring : springs) {
      if (!placement_.placed[spring.from] || !placement_.placed[spring.to]) continue;
      for (const Index node : {spring.from, spring.to}) {
        if (!problem_.is_anchor[node] && variable_[node] < 0) variable_[node] = count++;
      }
      const Index from = variable_[spring.from];
      const Index to = variable_[spring.to];
      if (from < 0 && to < 0) continue;
      springs_.push_back(spring);
      if (from >= 0 && to >= 0) pairs.emplace_back(from, to);
    }
    return {problem_.dimension, count, pairs};
  }

  Term term(const Spring& spring) const {
    const Point arm = placement_.positions.col(spring.from) - placement_.positions.col(spring.to);
    const double length = arm.norm();
    // Where both ends coincide the distance has no derivative; any direction serves.
    const Point direction =
        length > 0.0 ? Point(arm / length) : Point(Point::Unit(problem_.dimension, 0));
    const double residual = (length - spring.distance) / spring.sigma;
    return {direction / spring.sigma,
            residual,
            {residual > 0.0 ? spring.width_apart : spring.width_close}};
  }

  void add(const Spring& spring, std::size_t& pair) {
    const auto [slope, residual, kernel] = term(spring);
    const double weight = kernel.weight(residual * residual);
    const Block block = weight * slope * slope.transpose();
    const int d = problem_.dimension;
    const Index from = variable_[spring.from];
    const Index to = variable_[spring.to];
    if (from >= 0) {
      gradient_.segment(from * d, d) += weight * residual * slope;
      matrix_.add_diagonal(from, block);
    }
    if (to >= 0) {
      gradient_.segment(to * d, d) -= weight * residual * slope;
      matrix_.add_diagonal(to, block);
    }
    if (from >= 0 && to >= 0) matrix_.add_pair(pair++, -block);
  }

  const RangeProblem& problem_;
  Placement& placement_;
  std::vector<Index> variable_;  // a node's block, or -1 if it does not move
  std::vector<Spring> springs_;
  spectral::BlockCholesky matrix_;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd step_;
  Eigen::MatrixXd before_;
  double scale_ = 1.0;
};

}  // namespace

RefineOutcome refine(const RangeProblem& problem, const std::vector<bool>& use,
                     Placement& placement, const RefineOptions& options) {
  std::vector<Spring> springs;
  for (std::size_t k = 0; k < problem.ranges.size(); ++k) {
    if (!use[k]) continue;
    const auto& range = problem.ranges[k];
    springs.push_back(
        {range.from, range.to, range.distance, problem.sigmas[k], options.width, options.width});
  }
  return refine(problem, springs, placement, options);
}

RefineOutcome refine(const RangeProblem& problem, const std::vector<Spring>& springs,
                     Placement& placement, const RefineOptions& options) {
  constexpr double kStillStep = 1e-6;  // of the typical standard deviation
  const double still_step = kStillStep * problem.typical_sigma;
  SparseSystem system(problem, springs, placement);
  if (system.unknowns() == 0) return {};
  double damping = 1e-4;
  double cost = system.cost();
  for (int k = 0; k < options.max_iterations; ++k) {
    const Progress progress{"refinement", static_cast<std::uint64_t>(k),
                            static_cast<std::uint64_t>(options.max_iterations)};
    if (options.progress && !options.progress(progress)) throw Cancelled();
    const double before = cost;
    const bool moved = spectral::damped_step(system, damping, cost);
    if (!moved || before - cost <= options.still * before || system.largest_step() <= still_step) {
      return {k + 1, true};
    }
  }
  return {options.max_iterations, false};
}

}  // namespace isotherm::network::detail
