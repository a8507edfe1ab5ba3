#include "localize/refine/refine.hpp"

#include <cmath>
#include <utility>

#include <Eigen/CholmodSupport>

#include "isotherm/base/error.hpp"
#include "localize/problem/damped_step.hpp"
#include "localize/problem/small_network.hpp"

namespace isotherm::network::detail {
namespace {

using Factor = Eigen::CholmodDecomposition<spectral::SparseMatrix, Eigen::Lower>;

// The springs as a damped least-squares problem in the free nodes.
class SparseSystem {
 public:
  SparseSystem(const RangeProblem& problem, const std::vector<Spring>& springs,
               Placement& placement)
      : problem_(problem), placement_(placement) {
    factor_.cholmod().print = 0;
    first_row_.assign(problem.nodes, -1);
    for (const auto& spring : springs) {
      if (!placement.placed[spring.from] || !placement.placed[spring.to]) continue;
      const bool from_free = number(spring.from);
      const bool to_free = number(spring.to);
      if (from_free || to_free) springs_.push_back(spring);
    }
  }

  Index unknowns() const { return unknowns_; }

  bool linearise() {
    entries_.clear();
    gradient_.setZero(unknowns_);
    for (const auto& spring : springs_) add(spring);
    matrix_.resize(unknowns_, unknowns_);
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
    const double scale = matrix_.diagonal().mean();
    if (!(scale > 0.0)) return false;
    scale_ = scale;
    if (!analysed_) factor_.analyzePattern(matrix_);
    analysed_ = true;
    return true;
  }

  bool move(double damping) {
    factor_.setShift(damping * scale_);
    factor_.factorize(matrix_);
    if (factor_.info() != Eigen::Success) return false;
    step_ = factor_.solve(-gradient_);
    before_ = placement_.positions;
    const int d = problem_.dimension;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (first_row_[v] >= 0) placement_.positions.col(v) += step_.segment(first_row_[v], d);
    }
    return true;
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

  // Gives a node its rows; false for an anchor.
  bool number(Index node) {
    if (problem_.is_anchor[node]) return false;
    if (first_row_[node] < 0) {
      first_row_[node] = unknowns_;
      unknowns_ += problem_.dimension;
    }
    return true;
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

  void add(const Spring& spring) {
    const auto [slope, residual, kernel] = term(spring);
    const double weight = kernel.weight(residual * residual);
    const Block block = weight * slope * slope.transpose();
    const int d = problem_.dimension;
    const Index ends[] = {first_row_[spring.from], first_row_[spring.to]};
    for (int a = 0; a < 2; ++a) {
      if (ends[a] < 0) continue;
      gradient_.segment(ends[a], d) += (a == 0 ? weight : -weight) * residual * slope;
      for (int b = 0; b < 2; ++b) {
        if (ends[b] >= 0) add_block(ends[a], ends[b], a == b ? 1.0 : -1.0, block);
      }
    }
  }

  void add_block(Index row, Index column, double sign, const Block& block) {
    for (int i = 0; i < problem_.dimension; ++i) {
      for (int j = 0; j < problem_.dimension; ++j) {
        if (row + i >= column + j) entries_.emplace_back(row + i, column + j, sign * block(i, j));
      }
    }
  }

  const RangeProblem& problem_;
  Placement& placement_;
  std::vector<Index> first_row_;  // node -> first row, -1 if it does not move
  std::vector<Spring> springs_;
  Index unknowns_ = 0;
  std::vector<Eigen::Triplet<double, Index>> entries_;
  spectral::SparseMatrix matrix_;  // lower triangle
  Eigen::VectorXd gradient_;
  Eigen::VectorXd step_;
  Eigen::MatrixXd before_;
  double scale_ = 1.0;
  bool analysed_ = false;
  Factor factor_;
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
    const bool moved = damped_step(system, damping, cost);
    if (!moved || before - cost <= options.still * before || system.largest_step() <= still_step) {
      return {k + 1, true};
    }
  }
  return {options.max_iterations, false};
}

}  // namespace isotherm::network::detail
