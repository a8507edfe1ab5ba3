#pragma once

#include <Eigen/Core>

#include "isotherm/spectral/eigen/eigen_decomposition.hpp"
#include "isotherm/spectral/sparse/laplacian_solver.hpp"

namespace isotherm::spectral::detail {

/// Eigenvectors of the largest eigenvalues of a Laplacian's pseudo-inverse, which
/// are those of the smallest of the Laplacian that are not null: Spectra's
/// implicitly restarted Lanczos method on a sparse factorisation.
///
/// Zero shift through grounding, because a small negative shift bunches
/// together every eigenvalue far below its size.
class PseudoInversePairs {
 public:
  /// One factorisation. Both arguments are kept by reference.
  PseudoInversePairs(const Laplacian& laplacian, const EigenOptions& options);

  /// n x `count`, orthonormal, from the complement of the null space and of the
  /// orthonormal columns of `locked`; fewer columns if the complement is smaller,
  /// or after the last restart some have not converged.
  /// @throws NumericalError, Cancelled
  Eigen::MatrixXd vectors(Index count, const Eigen::MatrixXd& locked);

 private:
  LaplacianSolver solver_;
  Index size_;
  Index null_count_;
  const EigenOptions& options_;
  std::uint64_t solves_ = 0;
};

}  // namespace isotherm::spectral::detail
