#include "prune/consensus/estimate/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/base/parallel.hpp"
#include "isotherm/base/random.hpp"
#include "isotherm/slam/optimize/initialize.hpp"
#include "isotherm/spectral/sparse/block_covariance.hpp"
#include "isotherm/spectral/sparse/earlier_factor.hpp"
#include "matrices/decompositions.hpp"
#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {
namespace {

// What steps below this many standard deviations of the links they move leave is of second order.
constexpr double kNear = 1.0;

// Operations of a factorisation that take as long as to linearise one link (measured).
constexpr double kFlopsOfLink = 5000.0;

}  // namespace

template <class Pose>
Estimate<Pose>::Estimate(const ReducedGraph<Pose>& graph, Pace pace)
    : graph_(&graph), poses_(graph.poses), component_(graph.chain), pace_(std::move(pace)) {}

template <class Pose>
void Estimate<Pose>::use(const ReducedGraph<Pose>& graph) {
  graph_ = &graph;
  factorised_ = false;
  move_.resize(0);
}

template <class Pose>
void Estimate<Pose>::lay_out(const std::vector<bool>& accepted) {
  const bool same = equations_ && accepted == laid_out_for_;
  if (same && factorised_) return;
  const PoseGraph<Pose> used = used_links(accepted);
  join_components(used);
  move_.resize(0);
  if (same) {
    equations_->measure(used);
  } else {
    equations_.emplace(used, spectral::FactorForm::supernodal);
    has_factor_ = false;
    laid_out_for_ = accepted;
  }
  component_ = equations_->gauge().component;
}

template <class Pose>
typename Pose::Matrix Estimate<Pose>::loop_information(std::size_t used,
                                                       const CovarianceScale& scale) const {
  const Index loop = used_loops_[used];
  if (!information_.empty()) return information_[loop];
  return 1.0 / scale.loops * graph_->loops[loop].information;
}

template <class Pose>
void Estimate<Pose>::linearize(const CovarianceScale& scale) {
  const auto step_count = static_cast<Index>(graph_->steps.size());
  for (std::size_t k = 0; k < used_loops_.size(); ++k) {
    equations_->inform(step_count + static_cast<Index>(k), loop_information(k, scale));
  }
  const auto scaling = [&](Index link, double) {
    const double factor = link < step_count ? 1.0 / scale.odometry : 1.0;
    return EdgeScaling{factor, factor, 0.0};
  };
  linearized_ = poses_;
  equations_->linearize(poses_, scaling);
  factorised_ = false;
  if (pace_) pace_(work());
}

template <class Pose>
void Estimate<Pose>::factorise() {
  has_factor_ = false;
  if (!equations_->hessian().factorise()) {
    throw NumericalError("consensus", "the normal equations are not positive definite");
  }
  has_factor_ = factorised_ = true;
}

template <class Pose>
double Estimate<Pose>::work() const {
  return static_cast<double>(equations_->constraint_count()) +
         equations_->hessian().flops() / kFlopsOfLink;
}

// Gauss-Newton's, by the factor of an earlier one where that is near enough.
template <class Pose>
Eigen::VectorXd Estimate<Pose>::next_move() {
  if (has_factor_ && !factorised_) {
    auto move = spectral::solve_by_earlier_factor(equations_->hessian(), -equations_->gradient());
    if (move) return *std::move(move);
  }
  if (!factorised_) factorise();
  return equations_->hessian().solve(-equations_->gradient());
}

// Its length in deviations of a link (root mean square): the Newton decrement is the squared
// length.
template <class Pose>
double Estimate<Pose>::step() {
  move_ = next_move();
  const double decrement = -move_.dot(equations_->gradient());
  equations_->retract(move_, poses_);
  return std::sqrt(std::max(decrement, 0.0) / static_cast<double>(1 + used_loops_.size()));
}

template <class Pose>
void Estimate<Pose>::update(const std::vector<bool>& accepted, const CovarianceScale& scale,
                            int max_steps) {
  settle(accepted, scale, max_steps, [] { return false; });
}

template <class Pose>
void Estimate<Pose>::settle(const std::vector<bool>& accepted, const CovarianceScale& scale,
                            int max_steps, const std::function<bool()>& reweigh) {
  lay_out(accepted);
  bool weighed = false;
  bool settled = false;
  for (int k = 0; k < max_steps && !settled; ++k) {
    linearize(scale);
    const double length = step();
    weighed = length < kNear;
    settled = weighed && !reweigh() && length < kSettled;
  }
  if (settled && factorised_) return;
  if (!weighed) reweigh();
  linearize(scale);
  factorise();
  step();
}

template <class Pose>
void Estimate<Pose>::restore(Layout layout) {
  poses_ = std::move(layout.poses);
  component_ = std::move(layout.component);
  factorised_ = false;
  move_.resize(0);
}

template <class Pose>
void Estimate<Pose>::lay_out_anew(const std::vector<bool>& accepted, const CovarianceScale& scale) {
  PoseGraph<Pose> used = used_links(accepted);
  join_components(used);
  const std::size_t steps = graph_->steps.size();
  for (std::size_t k = 0; k < used.constraints.size(); ++k) {
    Matrix& information = used.constraints[k].information;
    information = k < steps ? information / scale.odometry : loop_information(k - steps, scale);
  }
  used.poses = poses_;
  restore({initial_poses(used, {}, Initialization::chordal), component_});
}

template <class Pose>
bool Estimate<Pose>::differs_from(const Layout& layout, const CovarianceScale& scale) const {
  double sum = 0.0;
  double count = 0.0;
  const auto compare = [&](const Link<Pose>& link, const Matrix& information) {
    const Pose before = layout.poses[link.a].between(layout.poses[link.b]);
    const Tangent d = before.between(poses_[link.a].between(poses_[link.b])).log();
    sum += d.dot(information * d);
    count += 1.0;
  };
  for (const auto& step : graph_->steps) compare(step, step.information / scale.odometry);
  for (std::size_t k = 0; k < used_loops_.size(); ++k) {
    compare(graph_->loops[used_loops_[k]], loop_information(k, scale));
  }
  return sum > kSettled * kSettled * count;
}

// Of a link, where the factor was formed.
template <class Pose>
struct Estimate<Pose>::AtFactor {
  Pose T_a_b;
  Tangent residual;
};

template <class Pose>
typename Estimate<Pose>::AtFactor Estimate<Pose>::at_factor(const Link<Pose>& link) const {
  const Pose T_a_b = linearized_[link.a].between(linearized_[link.b]);
  return {T_a_b, link.T_a_b.between(T_a_b).log()};
}

// d(T_a^-1 T_b) = -Ad d_a + d_b, with Ad the adjoint of T_b_a.
template <class Pose>
typename Estimate<Pose>::Derivative Estimate<Pose>::derivative(const Link<Pose>& link) const {
  const auto [T_a_b, r] = at_factor(link);
  const Matrix J = residual_jacobian<Pose>(r);
  return {r, -J * T_a_b.inverse().adjoint(), J};
}

// Far turns are those of many steps, each of which turns by little.
template <class Pose>
std::vector<Pose> Estimate<Pose>::moved(const Eigen::VectorXd& moves) const {
  std::vector<Pose> map = poses_;
  const auto of = [&](Index node) -> Tangent {
    const Index v = equations_->gauge().variable[node];
    if (v < 0) return Tangent::Zero();
    return moves.template segment<Pose::kDof>(v * Pose::kDof);
  };
  equations_->retract(moves, map);
  for (std::size_t k = 0; k < graph_->contracted; ++k) {
    const auto& step = graph_->steps[k];
    const Pose T_a_b = poses_[step.a].between(poses_[step.b]);
    const Tangent change = of(step.b) - T_a_b.inverse().adjoint() * of(step.a);
    map[step.b] = map[step.a] * T_a_b * Pose::exp(change);
  }
  return map;
}

template <class Pose>
void Estimate<Pose>::follow(const Eigen::VectorXd& moves) {
  poses_ = moved(moves);
  factorised_ = false;
  move_.resize(0);
}

template <class Pose>
typename Pose::Tangent Estimate<Pose>::residual(const Link<Pose>& link) const {
  if (move_.size() == 0) {
    return link.T_a_b.between(poses_[link.a].between(poses_[link.b])).log();
  }
  const auto [T_a_b, r] = at_factor(link);
  const Index a = equations_->gauge().variable[link.a];
  const Index b = equations_->gauge().variable[link.b];
  Tangent d = Tangent::Zero();
  if (a >= 0) d -= T_a_b.inverse().adjoint() * move_.template segment<Pose::kDof>(a * Pose::kDof);
  if (b >= 0) d += move_.template segment<Pose::kDof>(b * Pose::kDof);
  return r + residual_jacobian<Pose>(r) * d;
}

// To that of the cost: what a link adds whose residual is off by each of `errors`, in its own
// deviations.
template <class Pose>
void Estimate<Pose>::add_errors(const Link<Pose>& link, const Matrix& information,
                                std::span<const Tangent> errors, Eigen::MatrixXd& gradients) const {
  const auto [r, by_a, by_b] = derivative(link);
  const Eigen::LLT<Matrix> root(information);
  const Index a = equations_->gauge().variable[link.a];
  const Index b = equations_->gauge().variable[link.b];
  for (std::size_t m = 0; m < errors.size(); ++m) {
    auto gradient = gradients.col(static_cast<Index>(m));
    const Tangent u = root.matrixL() * errors[m];
    if (a >= 0) gradient.template segment<Pose::kDof>(a * Pose::kDof) += by_a.transpose() * u;
    if (b >= 0) gradient.template segment<Pose::kDof>(b * Pose::kDof) += by_b.transpose() * u;
  }
}

// Where least squares would be had every link another error: those solutions have the covariance
// of the poses (Papandreou and Yuille, Perturb-and-MAP random fields, ICCV 2011).
template <class Pose>
Eigen::MatrixXd Estimate<Pose>::drawn(const CovarianceScale& scale, std::size_t count) const {
  std::vector<Random> random;
  for (std::size_t seed = 0; seed < count; ++seed) random.emplace_back(seed);
  std::vector<Tangent> errors(count);
  const auto next_errors = [&]() -> std::span<const Tangent> {
    for (std::size_t m = 0; m < count; ++m) errors[m] = random[m].normal_vector<Tangent>();
    return errors;
  };
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(move_.size(), static_cast<Eigen::Index>(count));
  for (const auto& step : graph_->steps) {
    add_errors(step, step.information / scale.odometry, next_errors(), gradients);
  }
  std::size_t used = 0;
  for (std::size_t k = 0; k < graph_->loops.size(); ++k) {
    const auto of_loop = next_errors();
    if (used == used_loops_.size() || used_loops_[used] != static_cast<Index>(k)) continue;
    add_errors(graph_->loops[k], loop_information(used++, scale), of_loop, gradients);
  }
  return equations_->hessian().solve(gradients);
}

template <class Pose>
std::pair<Index, Index> Estimate<Pose>::parts(const Link<Pose>& loop) const {
  return {component_[loop.a], component_[loop.b]};
}

// Of u + v the covariance is no more than twice the sum of those of u and v.
template <class Pose>
std::vector<typename Pose::Matrix> Estimate<Pose>::residual_covariances(
    const Links& links, int threads, const Links& bounded) const {
  const auto row = [this](const Link<Pose>& link, Index end) {
    return link.a == link.b ? Index{-1} : equations_->gauge().variable[end];
  };
  std::vector<std::pair<Index, Index>> pairs;
  pairs.reserve(links.size() + 2 * bounded.size());
  for (const auto* link : links) pairs.emplace_back(row(*link, link->a), row(*link, link->b));
  for (const auto* link : bounded) {
    pairs.emplace_back(row(*link, link->a), -1);
    pairs.emplace_back(-1, row(*link, link->b));
  }
  const auto known = spectral::pair_covariances<Pose::kDof>(equations_->hessian(), pairs, threads);
  std::vector<Matrix> covariances(links.size() + bounded.size());
  parallel_for_each(covariances.size(), threads, [&](std::size_t k) {
    const bool exact = k < links.size();
    const auto [r, by_a, by_b] = derivative(exact ? *links[k] : *bounded[k - links.size()]);
    const auto& of_a = known[exact ? k : 2 * k - links.size()];
    const auto& of_b = known[exact ? k : 2 * k - links.size() + 1];
    const Matrix alone =
        by_a * of_a.first * by_a.transpose() + by_b * of_b.second * by_b.transpose();
    const Matrix across = exact ? Matrix(by_a * of_a.cross * by_b.transpose()) : 0.5 * alone;
    covariances[k] = alone + across + across.transpose();
  });
  return covariances;
}

template <class Pose>
double Estimate<Pose>::odometry_cost() const {
  double cost = 0.0;
  for (const auto& step : graph_->steps) {
    const Tangent r = residual(step);
    cost += r.dot(step.information * r);
  }
  return cost;
}

// Odometry, then the accepted loops between different nodes.
template <class Pose>
PoseGraph<Pose> Estimate<Pose>::used_links(const std::vector<bool>& accepted) {
  PoseGraph<Pose> used;
  used.ids.assign(graph_->vertex.begin(), graph_->vertex.end());
  const auto add = [&](const Link<Pose>& link) {
    used.constraints.push_back({link.a, link.b, link.T_a_b, link.information});
  };
  for (const auto& step : graph_->steps) add(step);
  used_loops_.clear();
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    const auto& loop = graph_->loops[k];
    if (!accepted[k] || loop.a == loop.b) continue;
    used_loops_.push_back(static_cast<Index>(k));
    add(loop);
  }
  return used;
}

// Where a link joins two components that were apart in the last update, the poses of the
// later one follow the link.
template <class Pose>
void Estimate<Pose>::join_components(const PoseGraph<Pose>& used) {
  for (const auto& link : used.constraints) {
    const Index stays = component_[link.from];
    const Index follows = component_[link.to];
    if (stays == follows) continue;
    const Pose shift = poses_[link.from] * link.T_from_to * poses_[link.to].inverse();
    for (std::size_t v = 0; v < poses_.size(); ++v) {
      if (component_[v] != follows) continue;
      poses_[v] = shift * poses_[v];
      component_[v] = stays;
    }
  }
}

template class Estimate<Pose2>;
template class Estimate<Pose3>;

}  // namespace isotherm::slam::detail
