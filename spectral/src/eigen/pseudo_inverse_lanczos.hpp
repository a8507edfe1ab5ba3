#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "isotherm/base/random.hpp"
#include "isotherm/spectral/eigen/eigen_decomposition.hpp"
#include "isotherm/spectral/sparse/laplacian_solver.hpp"

namespace isotherm::spectral::detail {

/// Thick-restart Lanczos (Wu and Simon 2000) with full reorthogonalisation on
/// the pseudo-inverse of a Laplacian, whose largest eigenvalues belong to the
/// smallest of the Laplacian that are not 0.
///
/// Zero shift through grounding, because a small negative shift bunches
/// together every eigenvalue far below its size. Thick rather than implicit
/// restarts, because implicit shifts that coincide with a wanted multiple
/// eigenvalue (complete graphs, stars) annihilate its copies.
class PseudoInverseLanczos {
 public:
  /// One factorisation. Both arguments are kept by reference.
  PseudoInverseLanczos(const Laplacian& laplacian, const EigenOptions& options);

  struct Pairs {
    Eigen::VectorXd values;   ///< of the Laplacian, ascending
    Eigen::MatrixXd vectors;  ///< n x values.size()
  };

  /// The pairs of the `count` largest eigenvalues of the pseudo-inverse on the
  /// complement of the null space and of the orthonormal columns of `locked`;
  /// fewer if the complement is smaller. Pairs that have not converged after
  /// the last restart come back as they are: their residuals tell.
  Pairs largest(Index count, const Eigen::MatrixXd& locked);

 private:
  struct Basis;

  Eigen::VectorXd multiply(const Eigen::VectorXd& x, const Eigen::MatrixXd& locked);
  Eigen::VectorXd random_direction(const Basis& basis, const Eigen::MatrixXd& locked);
  void extend(Basis& basis, Index size, const Eigen::MatrixXd& locked);

  LaplacianSolver solver_;
  Index size_;
  Index null_count_;
  const EigenOptions& options_;
  Random random_;
  std::uint64_t solves_ = 0;
};

}  // namespace isotherm::spectral::detail
