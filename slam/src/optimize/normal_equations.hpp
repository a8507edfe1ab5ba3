#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "graph/gauge.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/spectral/sparse/block_cholesky.hpp"

namespace isotherm::slam::detail {

/// How one constraint enters the normal equations at a linearisation point: with
/// J its Jacobian, r its residual and u = J' Omega r,
///
///     gradient += gradient * u,   H += hessian * J' Omega J - rank_one * u u'.
///
/// Least squares has (1, 1, 0); a robust kernel rho has (rho', rho', 0); a
/// variable that only this constraint sees, eliminated, gives the third term.
struct EdgeScaling {
  double gradient = 1.0;
  double hessian = 1.0;
  double rank_one = 0.0;
};

/// The scaling of a constraint, by its position and its chi-squared r' Omega r.
using EdgeScalingFunction = std::function<EdgeScaling(Index constraint, double chi2)>;

/// The Gauss-Newton system H step = -gradient of a pose graph's free poses.
///
/// Residuals and perturbations are those of `residual()`: right-handed, ordered
/// (translation, rotation). Omega is used as it is, without a square root, so
/// semi-definite information needs no special case. The gauge is fixed once.
template <class Pose>
class NormalEquations {
 public:
  /// Copies what it needs; the symbolic factorisation happens here.
  explicit NormalEquations(const PoseGraph<Pose>& graph,
                           spectral::FactorForm form = spectral::FactorForm::fastest);

  /// With a gauge of the caller's, and room for further terms that couple pairs of vertices.
  NormalEquations(const PoseGraph<Pose>& graph, Gauge gauge,
                  const std::vector<std::pair<Index, Index>>& couplings,
                  spectral::FactorForm form = spectral::FactorForm::fastest);

  /// Takes measurements and their information from the same graph with other ones.
  void measure(const PoseGraph<Pose>& graph) { edges_ = edges_of(graph, gauge_); }

  /// Takes other information of one constraint.
  void inform(Index constraint, const typename Pose::Matrix& information) {
    edges_[constraint].information = information;
  }

  const Gauge& gauge() const noexcept { return gauge_; }
  Index constraint_count() const noexcept { return static_cast<Index>(edges_.size()); }

  /// chi-squared of every constraint at `poses`. O(m).
  Eigen::VectorXd chi2(const std::vector<Pose>& poses) const;

  /// Sets up H and the gradient at `poses`; returns chi-squared per constraint. O(m).
  Eigen::VectorXd linearize(const std::vector<Pose>& poses, const EdgeScalingFunction& scaling);

  /// Adds a term of one vertex to H and the gradient; of a vertex that is held, nothing.
  void add_term(Index vertex, const typename Pose::Matrix& hessian,
                const typename Pose::Tangent& gradient);

  /// Adds to the block of H in the row of a coupling's first vertex and the column of its second.
  void add_coupling(Index coupling, const typename Pose::Matrix& hessian);

  /// H, and its factor once factorised.
  spectral::BlockCholesky& hessian() noexcept { return hessian_; }
  const spectral::BlockCholesky& hessian() const noexcept { return hessian_; }

  /// Half the derivative of the cost by the free poses.
  const Eigen::VectorXd& gradient() const noexcept { return gradient_; }

  /// Derivative of half of every chi-squared along `step`, from `poses`. O(m).
  Eigen::VectorXd slopes(const std::vector<Pose>& poses, const Eigen::VectorXd& step) const;

  /// Moves every free pose by its part of `step`: T exp(xi).
  void retract(const Eigen::VectorXd& step, std::vector<Pose>& poses) const;

 private:
  struct Edge {
    Index from;
    Index to;
    std::ptrdiff_t pair;  // off-diagonal block, or -1 if an end is held
    Pose T_to_from;       // inverse of the measurement
    typename Pose::Matrix information;
  };

  static std::vector<Edge> edges_of(const PoseGraph<Pose>& graph, const Gauge& gauge);
  static std::vector<std::ptrdiff_t> pairs_of(const std::vector<std::pair<Index, Index>>& couplings,
                                              const std::vector<Edge>& edges, const Gauge& gauge);
  static spectral::BlockCholesky pattern_of(const std::vector<Edge>& edges,
                                            const std::vector<std::pair<Index, Index>>& couplings,
                                            const Gauge& gauge, spectral::FactorForm form);
  void add_edge(const Edge& edge, const typename Pose::Matrix& hessian_to,
                const typename Pose::Tangent& gradient_to, const typename Pose::Matrix& adjoint);

  Gauge gauge_;
  std::vector<Edge> edges_;
  std::vector<std::ptrdiff_t> couplings_;  // their off-diagonal blocks, or -1
  spectral::BlockCholesky hessian_;
  Eigen::VectorXd gradient_;
};

extern template class NormalEquations<Pose2>;
extern template class NormalEquations<Pose3>;

}  // namespace isotherm::slam::detail
