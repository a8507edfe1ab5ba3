#pragma once

#include <cstdint>
#include <vector>

#include "distributed/eigen/grounded.hpp"
#include "distributed/eigen/mumps_factor.hpp"
#include "distributed/support/steps.hpp"

/// What iterates for eigenvectors: SLEPc, told what a Laplacian is.
namespace isotherm::spectral::distributed::detail {

/// Orthonormal vectors, by rows.
using Vectors = std::vector<VecHandle>;

/// Krylov-Schur on the pseudo-inverse of a Laplacian: the Laplacian is grounded and factorised, and
/// the null space taken out before and after each solve.
class PseudoInversePairs {
 public:
  /// `factor` is of `grounded`. All must outlive this.
  PseudoInversePairs(const NullSpace& null_space, const Grounded& grounded,
                     const MumpsFactor& factor, const LaplacianMatrix& laplacian,
                     const Steps& steps);

  /// Up to `count` vectors of the smallest eigenvalues, in the complement of `found`.
  Vectors find(std::int64_t count, const Vectors& found, int max_restarts);

 private:
  static PetscErrorCode multiply(Mat matrix, Vec x, Vec y);
  void apply(Vec x, Vec y);

  const NullSpace& null_space_;
  const Grounded& grounded_;
  const MumpsFactor& factor_;
  const LaplacianMatrix& laplacian_;
  const Steps& steps_;
  Bridge bridge_;
  VecHandle work_;
  std::int64_t solves_ = 0;
};

/// LOBPCG on a Laplacian with its null space lifted above the spectrum, preconditioned by
/// algebraic multigrid for the grounded matrix. Needs no factorisation.
Vectors lobpcg_pairs(const LaplacianMatrix& laplacian, const NullSpace& null_space,
                     std::int64_t count, double tolerance, int max_iterations, const Steps& steps);

/// Algebraic multigrid as a preconditioner of `matrix`: hypre's BoomerAMG where PETSc has it, else
/// PETSc's GAMG. PETSC_OPTIONS may name another, as for any PC, with the prefix `amg_`.
void use_multigrid(PC preconditioner);

/// Those that SLEPc found to converge, `count` at most.
Vectors converged_vectors(const Graph::State& graph, EPS solver, std::int64_t count);

}  // namespace isotherm::spectral::distributed::detail
