#pragma once

#include <memory>

#include <Eigen/Core>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

enum class FactorKind {
  positive_definite,  ///< supernodal or simplicial, as CHOLMOD judges
  symmetric,          ///< simplicial LDL' without pivoting; may be indefinite
};

/// A sparse Cholesky factorisation by CHOLMOD. Not safe for use by several
/// threads at once: CHOLMOD keeps its workspace in one place.
class CholmodFactor {
 public:
  /// Orders and factorises `matrix`, of which the lower triangle is read.
  /// @throws NumericalError if memory runs out or a pivot breaks down.
  CholmodFactor(const SparseMatrix& matrix, FactorKind kind);
  ~CholmodFactor();
  CholmodFactor(CholmodFactor&&) noexcept;

  Index size() const noexcept;

  /// x = A^-1 b, for n entries each; they may be the same memory.
  void solve(const double* b, double* x);

  /// Number of negative pivots, which by Sylvester's law is the number of
  /// negative eigenvalues. Only for FactorKind::symmetric.
  Index negative_pivots() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace isotherm::spectral::detail
