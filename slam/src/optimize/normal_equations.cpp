#include "optimize/normal_equations.hpp"

#include <algorithm>

namespace isotherm::slam::detail {

template <class Pose>
NormalEquations<Pose>::NormalEquations(const PoseGraph<Pose>& graph, spectral::FactorForm form)
    : NormalEquations(graph, fix_gauge(graph), {}, form) {}

template <class Pose>
NormalEquations<Pose>::NormalEquations(const PoseGraph<Pose>& graph, Gauge gauge,
                                       const std::vector<std::pair<Index, Index>>& couplings,
                                       spectral::FactorForm form)
    : gauge_(std::move(gauge)),
      edges_(edges_of(graph, gauge_)),
      couplings_(pairs_of(couplings, edges_, gauge_)),
      hessian_(pattern_of(edges_, couplings, gauge_, form)),
      gradient_(Eigen::VectorXd::Zero(hessian_.size())) {}

template <class Pose>
std::vector<typename NormalEquations<Pose>::Edge> NormalEquations<Pose>::edges_of(
    const PoseGraph<Pose>& graph, const Gauge& gauge) {
  std::vector<Edge> edges;
  edges.reserve(graph.constraints.size());
  std::ptrdiff_t pairs = 0;
  for (const auto& constraint : graph.constraints) {
    const bool coupled = constraint.from != constraint.to && gauge.variable[constraint.from] >= 0 &&
                         gauge.variable[constraint.to] >= 0;
    edges.push_back({constraint.from, constraint.to, coupled ? pairs++ : -1,
                     constraint.T_from_to.inverse(), constraint.information});
  }
  return edges;
}

template <class Pose>
std::vector<std::ptrdiff_t> NormalEquations<Pose>::pairs_of(
    const std::vector<std::pair<Index, Index>>& couplings, const std::vector<Edge>& edges,
    const Gauge& gauge) {
  auto next = std::ranges::count_if(edges, [](const Edge& edge) { return edge.pair >= 0; });
  std::vector<std::ptrdiff_t> pairs;
  pairs.reserve(couplings.size());
  for (const auto& [a, b] : couplings) {
    const bool both = a != b && gauge.variable[a] >= 0 && gauge.variable[b] >= 0;
    pairs.push_back(both ? next++ : -1);
  }
  return pairs;
}

template <class Pose>
spectral::BlockCholesky NormalEquations<Pose>::pattern_of(
    const std::vector<Edge>& edges, const std::vector<std::pair<Index, Index>>& couplings,
    const Gauge& gauge, spectral::FactorForm form) {
  std::vector<std::pair<Index, Index>> pairs;
  for (const Edge& edge : edges) {
    if (edge.pair >= 0) pairs.emplace_back(gauge.variable[edge.from], gauge.variable[edge.to]);
  }
  for (const auto& [a, b] : couplings) {
    const bool both = a != b && gauge.variable[a] >= 0 && gauge.variable[b] >= 0;
    if (both) pairs.emplace_back(gauge.variable[a], gauge.variable[b]);
  }
  return spectral::BlockCholesky(Pose::kDof, gauge.variable_count, pairs, form);
}

template <class Pose>
void NormalEquations<Pose>::add_term(Index vertex, const typename Pose::Matrix& hessian,
                                     const typename Pose::Tangent& gradient) {
  const Index variable = gauge_.variable[vertex];
  if (variable < 0) return;
  hessian_.add_diagonal(variable, hessian);
  gradient_.template segment<Pose::kDof>(Eigen::Index{variable} * Pose::kDof) += gradient;
}

template <class Pose>
void NormalEquations<Pose>::add_coupling(Index coupling, const typename Pose::Matrix& hessian) {
  const auto pair = couplings_[coupling];
  if (pair >= 0) hessian_.add_pair(static_cast<std::size_t>(pair), hessian);
}

template <class Pose>
Eigen::VectorXd NormalEquations<Pose>::chi2(const std::vector<Pose>& poses) const {
  Eigen::VectorXd result(constraint_count());
  for (Index k = 0; k < constraint_count(); ++k) {
    const Edge& edge = edges_[k];
    const Pose T_from_to = poses[edge.from].between(poses[edge.to]);
    const typename Pose::Tangent r = (edge.T_to_from * T_from_to).log();
    result[k] = r.dot(edge.information * r);
  }
  return result;
}

template <class Pose>
Eigen::VectorXd NormalEquations<Pose>::linearize(const std::vector<Pose>& poses,
                                                 const EdgeScalingFunction& scaling) {
  hessian_.clear();
  gradient_.setZero();
  Eigen::VectorXd chi2(constraint_count());
  for (Index k = 0; k < constraint_count(); ++k) {
    const Edge& edge = edges_[k];
    const Pose T_from_to = poses[edge.from].between(poses[edge.to]);
    const typename Pose::Tangent r = (edge.T_to_from * T_from_to).log();
    const typename Pose::Tangent weighted = edge.information * r;
    chi2[k] = r.dot(weighted);
    if (edge.from == edge.to) continue;  // constant, whatever the poses

    // By the pose of `to` the residual changes as log(exp(r) exp(d)).
    const typename Pose::Matrix jacobian = Pose::right_jacobian_inverse(r);
    const typename Pose::Tangent u = jacobian.transpose() * weighted;
    const EdgeScaling scale = scaling(k, chi2[k]);
    typename Pose::Matrix h =
        scale.hessian * (jacobian.transpose() * (edge.information * jacobian));
    if (scale.rank_one != 0.0) h -= scale.rank_one * (u * u.transpose());
    add_edge(edge, h, scale.gradient * u, T_from_to.inverse().adjoint());
  }
  return chi2;
}

// A perturbation d of `from` acts on the residual as -Ad d of `to` does, with Ad
// the adjoint of T_to_from.
template <class Pose>
void NormalEquations<Pose>::add_edge(const Edge& edge, const typename Pose::Matrix& hessian_to,
                                     const typename Pose::Tangent& gradient_to,
                                     const typename Pose::Matrix& adjoint) {
  const Index from = gauge_.variable[edge.from];
  const Index to = gauge_.variable[edge.to];
  if (to >= 0) {
    hessian_.add_diagonal(to, hessian_to);
    gradient_.template segment<Pose::kDof>(Eigen::Index{to} * Pose::kDof) += gradient_to;
  }
  if (from >= 0) {
    const typename Pose::Matrix cross = -adjoint.transpose() * hessian_to;
    hessian_.add_diagonal(from, (-cross * adjoint).eval());
    gradient_.template segment<Pose::kDof>(Eigen::Index{from} * Pose::kDof) -=
        adjoint.transpose() * gradient_to;
    if (edge.pair >= 0) hessian_.add_pair(static_cast<std::size_t>(edge.pair), cross);
  }
}

template <class Pose>
Eigen::VectorXd NormalEquations<Pose>::slopes(const std::vector<Pose>& poses,
                                              const Eigen::VectorXd& step) const {
  const auto part = [&](Index vertex) -> typename Pose::Tangent {
    const Index variable = gauge_.variable[vertex];
    if (variable < 0) return Pose::Tangent::Zero();
    return step.template segment<Pose::kDof>(Eigen::Index{variable} * Pose::kDof);
  };
  Eigen::VectorXd result(constraint_count());
  for (Index k = 0; k < constraint_count(); ++k) {
    const Edge& edge = edges_[k];
    const Pose T_from_to = poses[edge.from].between(poses[edge.to]);
    const typename Pose::Tangent r = (edge.T_to_from * T_from_to).log();
    const typename Pose::Tangent moved =
        Pose::right_jacobian_inverse(r) *
        (part(edge.to) - T_from_to.inverse().adjoint() * part(edge.from));
    result[k] = r.dot(edge.information * moved);
  }
  return result;
}

template <class Pose>
void NormalEquations<Pose>::retract(const Eigen::VectorXd& step, std::vector<Pose>& poses) const {
  for (std::size_t v = 0; v < poses.size(); ++v) {
    const Index variable = gauge_.variable[v];
    if (variable < 0) continue;
    const typename Pose::Tangent xi =
        step.template segment<Pose::kDof>(Eigen::Index{variable} * Pose::kDof);
    poses[v] = poses[v] * Pose::exp(xi);
  }
}

template class NormalEquations<Pose2>;
template class NormalEquations<Pose3>;

}  // namespace isotherm::slam::detail
