#pragma once

#include "distributed/eigen/grounded.hpp"
#include "distributed/support/steps.hpp"

namespace isotherm::spectral::distributed::detail {

/// Potentials for currents: conjugate gradients on the grounded Laplacian, preconditioned by
/// algebraic multigrid.
class MultigridSolver {
 public:
  MultigridSolver(const LaplacianMatrix& laplacian, int max_iterations);

  /// Until the residual of the grounded equations is below `absolute`. What x holds is where it
  /// starts; it ends with nothing of the null space. `currents` add up to 0 in each component.
  void solve(Vec currents, double absolute, Vec x);

  const NullSpace& null_space() const { return null_space_; }

 private:
  Grounded grounded_;
  NullSpace null_space_;
  int max_iterations_;
  KspHandle solver_;
  VecHandle work_;
};

}  // namespace isotherm::spectral::distributed::detail
