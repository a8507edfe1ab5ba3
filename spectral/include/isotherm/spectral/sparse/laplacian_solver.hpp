#pragma once

#include <memory>

#include <Eigen/Core>

#include "isotherm/spectral/graph/laplacian.hpp"

namespace isotherm::spectral {

/// Applies the pseudo-inverse of a Laplacian of either kind through one sparse
/// factorisation.
///
/// One vertex per component is grounded, so that nothing is regularised: the
/// result is exact to rounding. Keep one per thread: solving uses a workspace.
class LaplacianSolver {
 public:
  /// One CHOLMOD factorisation.
  /// @throws NumericalError if it breaks down.
  explicit LaplacianSolver(const Laplacian& laplacian);
  ~LaplacianSolver();
  LaplacianSolver(LaplacianSolver&&) noexcept;
  LaplacianSolver& operator=(LaplacianSolver&&) noexcept;

  /// x = L^+ b, n entries. The part of `b` in the null space is ignored, and
  /// `x` has none. Cost: two triangular solves.
  /// @throws InvalidArgument unless `b` has n entries.
  Eigen::VectorXd solve(const Eigen::Ref<const Eigen::VectorXd>& b);

  /// Takes the null-space part out of a vector of n entries. O(n).
  void remove_null_space(Eigen::Ref<Eigen::VectorXd> x) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace isotherm::spectral
