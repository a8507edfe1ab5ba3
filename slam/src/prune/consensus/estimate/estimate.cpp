#include "prune/consensus/estimate/estimate.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "graph/find_root.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/spectral/sparse/block_covariance.hpp"

namespace isotherm::slam::detail {
namespace {

// Steps below this many standard deviations of the links they move do not matter.
constexpr double kSettled = 0.1;

}  // namespace

template <class Pose>
Estimate<Pose>::Estimate(const ReducedGraph<Pose>& graph)
    : graph_(graph), poses_(graph.poses), component_(graph.chain) {
  // Chains are numbered in order, but some may have no node.
  Index previous = -1;
  for (Index& chain : component_) {
    if (chain != previous) ++component_count_;
    previous = chain;
    chain = component_count_ - 1;
  }
}

template <class Pose>
void Estimate<Pose>::update(const std::vector<bool>& accepted, const CovarianceScale& scale,
                            int max_steps) {
  if (!factor_ || accepted != laid_out_for_) lay_out(accepted);
  for (int step = 0;; ++step) {
    const Eigen::VectorXd gradient = linearise(scale);
    if (!factor_->factorise()) {
      throw NumericalError("consensus", "the normal equations are not positive definite");
    }
    if (step == max_steps) return;
    const Eigen::VectorXd move = factor_->solve(gradient);
    const double decrement = move.dot(gradient);
    retract(move);
    // The Newton decrement is the squared length of the step in deviations.
    if (decrement < kSettled * kSettled * static_cast<double>(1 + active_loops_.size())) return;
  }
}

template <class Pose>
void Estimate<Pose>::restore(Layout layout) {
  poses_ = std::move(layout.poses);
  component_ = std::move(layout.component);
  factor_.reset();
}

template <class Pose>
typename Pose::Tangent Estimate<Pose>::residual(const Link<Pose>& link) const {
  return (link.T_a_b.inverse() * (poses_[link.a].inverse() * poses_[link.b])).log();
}

template <class Pose>
bool Estimate<Pose>::connected(const Link<Pose>& loop) const {
  return component_[loop.a] == component_[loop.b];
}

// d(T_a^-1 T_b) = -Ad d_a + d_b, with Ad the adjoint of T_b_a.
template <class Pose>
std::vector<typename Pose::Matrix> Estimate<Pose>::relative_covariances(
    std::span<const Index> loops) const {
  std::vector<std::pair<Index, Index>> pairs;
  pairs.reserve(loops.size());
  for (const Index k : loops) {
    const auto& loop = graph_.loops[k];
    const bool turns_back = loop.a == loop.b;
    pairs.emplace_back(turns_back ? -1 : variable_[loop.a], turns_back ? -1 : variable_[loop.b]);
  }
  const auto known = spectral::pair_covariances<Pose::kDof>(*factor_, pairs);
  std::vector<Matrix> covariances;
  covariances.reserve(loops.size());
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto& loop = graph_.loops[loops[k]];
    const Matrix adjoint = (poses_[loop.b].inverse() * poses_[loop.a]).adjoint();
    const Matrix across = adjoint * known[k].cross;
    covariances.push_back(adjoint * known[k].first * adjoint.transpose() + known[k].second -
                          across - across.transpose());
  }
  return covariances;
}

template <class Pose>
double Estimate<Pose>::odometry_cost() const {
  double cost = 0.0;
  for (const auto& step : graph_.steps) {
    const Tangent r = residual(step);
    cost += r.dot(step.information * r);
  }
  return cost;
}

// Components are rebuilt; where a link joins two that were apart
// in the last update, the poses of the later one follow the link.
template <class Pose>
void Estimate<Pose>::join_components(const std::vector<bool>& accepted) {
  std::vector<Index> parent(poses_.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto join = [&](const Link<Pose>& link) {
    parent[find_root(parent, link.b)] = find_root(parent, link.a);
    if (connected(link)) return;
    const Index stays = component_[link.a];
    const Index follows = component_[link.b];
    const Pose shift = poses_[link.a] * link.T_a_b * poses_[link.b].inverse();
    for (std::size_t v = 0; v < poses_.size(); ++v) {
      if (component_[v] != follows) continue;
      poses_[v] = shift * poses_[v];
      component_[v] = stays;
    }
  };
  for (const auto& step : graph_.steps) join(step);
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    if (accepted[k]) join(graph_.loops[k]);
  }

  std::vector<Index> number(poses_.size(), -1);
  component_count_ = 0;
  for (std::size_t v = 0; v < poses_.size(); ++v) {
    Index& component = number[find_root(parent, static_cast<Index>(v))];
    if (component < 0) component = component_count_++;
    component_[v] = component;
  }
}

template <class Pose>
void Estimate<Pose>::hold_one_pose_each() {
  std::vector<bool> held(component_count_, false);
  variable_.assign(poses_.size(), -1);
  variable_count_ = 0;
  for (std::size_t v = 0; v < poses_.size(); ++v) {
    if (held[component_[v]]) {
      variable_[v] = variable_count_++;
    } else {
      held[component_[v]] = true;
    }
  }
}

template <class Pose>
void Estimate<Pose>::lay_out(const std::vector<bool>& accepted) {
  join_components(accepted);
  hold_one_pose_each();
  laid_out_for_ = accepted;
  active_loops_.clear();
  pair_of_.clear();
  std::vector<std::pair<Index, Index>> pairs;
  const auto place = [&](const Link<Pose>& link) {
    const Index a = variable_[link.a];
    const Index b = variable_[link.b];
    if (a < 0 || b < 0) {
      pair_of_.push_back(-1);
    } else {
      pair_of_.push_back(static_cast<std::ptrdiff_t>(pairs.size()));
      pairs.emplace_back(a, b);
    }
  };
  for (const auto& step : graph_.steps) place(step);
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    const auto& loop = graph_.loops[k];
    if (!accepted[k] || loop.a == loop.b) continue;
    active_loops_.push_back(static_cast<Index>(k));
    place(loop);
  }
  factor_ = std::make_unique<spectral::BlockCholesky>(Pose::kDof, variable_count_, pairs,
                                                      spectral::FactorForm::supernodal);
}

template <class Pose>
Eigen::VectorXd Estimate<Pose>::linearise(const CovarianceScale& scale) {
  factor_->clear();
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(Eigen::Index{variable_count_} * Pose::kDof);
  std::size_t at = 0;
  for (const auto& step : graph_.steps) add_link(step, scale.odometry, pair_of_[at++], rhs);
  for (const Index k : active_loops_) {
    add_link(graph_.loops[k], scale.loops, pair_of_[at++], rhs);
  }
  return rhs;
}

// A perturbation d of `a` acts on the residual as -Ad d of `b` does, with Ad the
// adjoint of T_b_a.
template <class Pose>
void Estimate<Pose>::add_link(const Link<Pose>& link, double scale, std::ptrdiff_t pair,
                              Eigen::VectorXd& rhs) {
  const Tangent r = residual(link);
  const Matrix jacobian = residual_jacobian<Pose>(r);
  const Matrix weighted = jacobian.transpose() * link.information / scale;
  const Matrix hessian = weighted * jacobian;
  const Tangent gradient = weighted * r;
  const Matrix adjoint = (poses_[link.b].inverse() * poses_[link.a]).adjoint();
  const Matrix cross = -adjoint.transpose() * hessian;
  const Index a = variable_[link.a];
  const Index b = variable_[link.b];
  if (a >= 0) {
    factor_->add_diagonal(a, -cross * adjoint);
    rhs.template segment<Pose::kDof>(Eigen::Index{a} * Pose::kDof) +=
        adjoint.transpose() * gradient;
  }
  if (b >= 0) {
    factor_->add_diagonal(b, hessian);
    rhs.template segment<Pose::kDof>(Eigen::Index{b} * Pose::kDof) -= gradient;
  }
  if (pair >= 0) factor_->add_pair(static_cast<std::size_t>(pair), cross);
}

template <class Pose>
void Estimate<Pose>::retract(const Eigen::VectorXd& step) {
  for (std::size_t v = 0; v < poses_.size(); ++v) {
    if (variable_[v] < 0) continue;
    const Tangent xi = step.template segment<Pose::kDof>(Eigen::Index{variable_[v]} * Pose::kDof);
    poses_[v] = poses_[v] * Pose::exp(xi);
  }
}

template class Estimate<Pose2>;
template class Estimate<Pose3>;

}  // namespace isotherm::slam::detail
