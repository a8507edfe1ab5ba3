#include "localize/refine/refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/sparse/damped_step.hpp"
#include "localize/constants.hpp"
#include "localize/problem/geman_mcclure.hpp"
#include "localize/problem/point_grid.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {
namespace {

constexpr double kAnyStep = std::numeric_limits<double>::infinity();

// What a spring of a length costs, twice, and half the derivatives of that by the length.
struct LengthCost {
  double cost = 0.0;
  double slope = 0.0;
  double curvature = 0.0;  // of a bound that holds here; >= 0
};

LengthCost of_spring(const Spring& spring, double length) {
  const double residual = (length - spring.distance) / spring.sigma;
  const GemanMcClure kernel{residual > 0.0 ? spring.width_apart : spring.width_close};
  const double weight = kernel.weight(residual * residual);
  return {kernel.loss(residual * residual), weight * residual / spring.sigma,
          weight / (spring.sigma * spring.sigma)};
}

// The springs as a damped least-squares problem in the free nodes.
template <class Cost>
class SparseSystem {
 public:
  SparseSystem(const RangeProblem& problem, const std::vector<Spring>& springs, Cost length_cost,
               double longest_step, Placement& placement)
      : problem_(problem),
        length_cost_(std::move(length_cost)),
        longest_step_(longest_step),
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
      if (variable_[v] < 0) continue;
      auto step = step_.segment(variable_[v] * d, d);
      if (step.norm() > longest_step_) step *= longest_step_ / step.norm();
      placement_.positions.col(v) += step;
    }
    return -step_.dot(gradient_);
  }

  void take_back() { placement_.positions = before_; }

  double cost() const {
    double sum = 0.0;
    for (const auto& spring : springs_)
      sum += length_cost_(spring, distance_of(placement_, spring.from, spring.to)).cost;
    return sum;
  }

  double largest_step() const { return step_.size() > 0 ? step_.cwiseAbs().maxCoeff() : 0.0; }

 private:
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
      if (from >= 0 && to >= 0 && spring.couples) pairs.emplace_back(from, to);
    }
    // Networks fill their factor as fields do, not as trajectories: dense blocks pay.
    return {problem_.dimension, count, pairs, spectral::FactorForm::supernodal};
  }

  Point arm(const Spring& spring) const {
    return placement_.positions.col(spring.from) - placement_.positions.col(spring.to);
  }

  void add(const Spring& spring, std::size_t& pair) {
    const Point apart = arm(spring);
    const double length = apart.norm();
    // Where both ends coincide the distance has no derivative; any direction serves.
    const Point direction =
        length > 0.0 ? Point(apart / length) : Point(Point::Unit(problem_.dimension, 0));
    const auto term = length_cost_(spring, length);
    const Block block = term.curvature * direction * direction.transpose();
    const int d = problem_.dimension;
    const Index from = variable_[spring.from];
    const Index to = variable_[spring.to];
    if (from >= 0) {
      gradient_.segment(from * d, d) += term.slope * direction;
      matrix_.add_diagonal(from, block);
    }
    if (to >= 0) {
      gradient_.segment(to * d, d) -= term.slope * direction;
      matrix_.add_diagonal(to, block);
    }
    if (from >= 0 && to >= 0 && spring.couples) matrix_.add_pair(pair++, -block);
  }

  const RangeProblem& problem_;
  Cost length_cost_;
  double longest_step_;  // of a node
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
  SparseSystem system(problem, springs, of_spring, kAnyStep, placement);
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

namespace {

// Beyond so many deviations a range pulls as hard wherever its ends are, so that no step needs to
// know of both together: what far nodes are joined by would fill the factor.
constexpr double kCouples = 8.0;
constexpr double kFirstDamping = 1e-6;
// Standard deviations that a node moves at a time: what is far outside of the noise has no
// curvature, and would throw a node that hangs on little to where nothing fits.
constexpr double kLongestStep = kApart;
constexpr double kNoGain = 1e-3;  // nats: what nobody can tell apart

std::vector<Spring> all_springs(const RangeProblem& problem, const Placement& placement) {
  std::vector<Spring> springs;
  for (std::size_t k = 0; k < problem.ranges.size(); ++k) {
    const auto& range = problem.ranges[k];
    if (!are_placed(placement, range.from, range.to)) continue;
    if (problem.is_anchor[range.from] && problem.is_anchor[range.to]) continue;
    Spring spring{range.from, range.to, range.distance, problem.sigmas[k]};
    const double error = distance_of(placement, range.from, range.to) - range.distance;
    spring.couples = std::abs(error) < kCouples * spring.sigma;
    springs.push_back(spring);
  }
  return springs;
}

// Pairs without a range that are near each other, or may come to be.
void add_absent(const RangeProblem& problem, const Absence& absence, const Placement& placement,
                std::vector<Spring>& springs) {
  constexpr double kAround = 1.25;  // reaches
  if (!(absence.reach() > 0.0)) return;
  const auto wanted = [&](Index a, Index b) {
    return !(problem.is_anchor[a] && problem.is_anchor[b]) && !has_range(problem, a, b);
  };
  for (const auto& [a, b] : near_nodes(placement, kAround * absence.reach(), wanted)) {
    springs.push_back({.from = a, .to = b, .couples = false, .absent = true});
  }
}

// Its curvature is that of a parabola with its bottom where absence costs nothing any more.
LengthCost of_absent(const Absence& absence, double length) {
  const double slope = absence.slope(length);
  const double rest = std::max(absence.reach() - length, absence.resolution());
  return {absence.cost(length), 0.5 * slope, -0.5 * slope / rest};
}

LengthCost of_kinds(const RangeMixture& model, const Absence& absence, const Spring& spring,
                    double length) {
  if (spring.absent) return of_absent(absence, length);
  const auto loss =
      range_loss(model, spring.distance - length, std::pow(model.sigma(spring.sigma), 2));
  return {2.0 * loss.cost, -loss.slope, loss.curvature};
}

RangeStatistics statistics_of(const RangeMixture& model, const std::vector<Spring>& springs,
                              const Placement& placement) {
  RangeStatistics statistics;
  for (const auto& spring : springs) {
    if (spring.absent) continue;
    const double error = spring.distance - distance_of(placement, spring.from, spring.to);
    statistics.add(range_moments(model, error, std::pow(model.sigma(spring.sigma), 2)));
  }
  return statistics;
}

// Damped steps until one gains nothing. After each, with its number, what springs cost may change
// by `learn`, which says whether it did.
template <class Cost, class Learn>
RefineOutcome climb(const RangeProblem& problem, const std::vector<Spring>& springs, Cost cost_of,
                    int max_iterations, const Learn& learn, Placement& placement) {
  SparseSystem system(problem, springs, cost_of, kLongestStep * problem.typical_sigma, placement);
  if (system.unknowns() == 0) return {};
  double damping = kFirstDamping;
  double cost = system.cost();
  for (int k = 1; k <= max_iterations; ++k) {
    const double before = cost;
    const bool moved = spectral::damped_step(system, damping, cost);
    if (learn(k)) cost = system.cost();
    if (!moved || before - cost < 2.0 * kNoGain) return {k, true};
  }
  return {max_iterations, false};
}

}  // namespace

RefineOutcome refine_likelihood(const RangeProblem& problem, const std::vector<Spring>& springs,
                                const Evidence& evidence, int max_iterations,
                                Placement& placement) {
  const auto cost_of = [&](const Spring& spring, double length) {
    return of_kinds(evidence.model, evidence.absence, spring, length);
  };
  return climb(
      problem, springs, cost_of, max_iterations, [](int) { return false; }, placement);
}

RefineOutcome refine_mixture(const RangeProblem& problem, const Absence& absence, bool too_long,
                             const LocalizeOptions& options, RangeMixture& model,
                             Placement& placement) {
  auto springs = all_springs(problem, placement);
  add_absent(problem, absence, placement, springs);
  const auto cost_of = [&](const Spring& spring, double length) {
    return of_kinds(model, absence, spring, length);
  };
  const double excess = typical_excess(problem.typical_sigma, model.longest);
  const auto learn = [&](int k) {
    const Progress done{"kinds of ranges", static_cast<std::uint64_t>(k),
                        static_cast<std::uint64_t>(options.max_iterations)};
    if (options.progress && !options.progress(done)) throw Cancelled();
    learn_kinds(statistics_of(model, springs, placement), excess, problem.typical_sigma, too_long,
                model);
    return true;
  };
  return climb(problem, springs, cost_of, options.max_iterations, learn, placement);
}

}  // namespace isotherm::network::detail
