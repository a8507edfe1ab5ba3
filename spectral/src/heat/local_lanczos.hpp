#pragma once

#include <cstdint>
#include <vector>

#include "heat/heat_target.hpp"
#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

/// The Lanczos process of a Laplacian started at e_i - e_j (or e_i), on the
/// touched ball only: after m steps the vectors live on the vertices within m
/// hops of {i, j}, so that a step costs the edges of that ball and not of the
/// graph.
///
/// Without reorthogonalisation: what is read off is the tridiagonal matrix,
/// and the quadrature rules of a finite-precision Lanczos matrix stay accurate
/// (Golub and Strakos 1994; Knizhnerman 1996), copies of converged eigenvalues
/// sharing the weight of one. docs/concepts/heat-distance.md has the argument
/// and the size of the rounding allowance.
class LocalLanczos {
 public:
  /// `laplacian` is symmetric, with both triangles stored, and outlives this.
  explicit LocalLanczos(const SparseMatrix& laplacian);

  /// Begins anew at the vector of a target, which is not trivial.
  void start(const HeatTarget& target);

  /// One step: appends to diagonal() and off_diagonal().
  void step();

  int steps() const { return static_cast<int>(diagonal_.size()); }

  /// The Krylov space is exhausted: the tridiagonal matrix says everything.
  bool exhausted() const { return exhausted_; }

  /// Lanczos matrix T_m; off_diagonal() has m entries, the last one (the norm
  /// of the next residual) couples to step m + 1.
  const std::vector<double>& diagonal() const { return diagonal_; }
  const std::vector<double>& off_diagonal() const { return off_diagonal_; }

  /// A bound on the norm of the Laplacian restricted to the touched ball.
  double norm_bound() const { return norm_bound_; }

  /// Matrix entries multiplied since start().
  std::int64_t work() const { return work_; }

 private:
  void discover(Index vertex);
  void expand_frontier();
  double weight_left(Index vertex, Index neighbour, double weight) const;

  const SparseMatrix* laplacian_;
  ExcludedEdge excluded_;
  std::vector<Index> local_of_;  // graph vertex -> position in ball_, or -1

  std::vector<Index> ball_;       // discovered vertices, nearest first
  std::vector<Index> row_start_;  // of expanded vertices, plus one
  std::vector<Index> columns_;    // positions in ball_
  std::vector<double> weights_;   // minus the Laplacian's off-diagonal entries
  std::vector<double> degrees_;   // of expanded vertices
  Index inner_ = 0;               // size of the support of previous_
  Index support_ = 0;             // size of the support of current_

  std::vector<double> previous_, current_, next_;
  std::vector<double> diagonal_, off_diagonal_;
  double norm_bound_ = 0.0;
  std::int64_t work_ = 0;
  bool exhausted_ = false;
};

}  // namespace isotherm::spectral::detail
