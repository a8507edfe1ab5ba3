#include "distributed/resistance/multigrid_solver.hpp"

#include "distributed/eigen/pairs.hpp"

namespace isotherm::spectral::distributed::detail {

MultigridSolver::MultigridSolver(const LaplacianMatrix& laplacian, int max_iterations)
    : grounded_(laplacian),
      null_space_(laplacian),
      max_iterations_(max_iterations),
      work_(make_vector(laplacian.graph())) {
  check(KSPCreate(laplacian.graph().comm().handle, solver_.out()));
  check(KSPSetOperators(solver_.get(), grounded_.get(), grounded_.get()));
  check(KSPSetType(solver_.get(), KSPCG));
  check(KSPSetNormType(solver_.get(), KSP_NORM_UNPRECONDITIONED));
  check(KSPSetInitialGuessNonzero(solver_.get(), PETSC_TRUE));
  PC preconditioner = nullptr;
  check(KSPGetPC(solver_.get(), &preconditioner));
  use_multigrid(preconditioner);
  check(KSPSetFromOptions(solver_.get()));
  check(KSPSetUp(solver_.get()));
}

void MultigridSolver::solve(Vec currents, double absolute, Vec x) {
  check(VecCopy(currents, work_.get()));
  grounded_.ground(work_.get());
  // Potentials against the grounded vertices, whatever they were before.
  grounded_.shift_to_ground(x);
  check(KSPSetTolerances(solver_.get(), 0.0, absolute, PETSC_DEFAULT, max_iterations_));
  check(KSPSolve(solver_.get(), work_.get(), x));
  grounded_.ground(x);
  null_space_.remove(x);
}

}  // namespace isotherm::spectral::distributed::detail
