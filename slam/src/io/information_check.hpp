#pragma once

#include <cmath>

#include "matrices/decompositions.hpp"

namespace isotherm::slam::detail {

/// Whether a symmetric matrix is positive semi-definite up to rounding.
///
/// Judged on the matrix scaled to a unit diagonal, so that metres and radians do
/// not matter: its smallest eigenvalue must be at least -1e-9.
template <class Matrix>
bool is_positive_semidefinite(const Matrix& m) {
  const Eigen::LLT<Matrix> cholesky(m);
  if (cholesky.info() == Eigen::Success && std::isfinite(cholesky.matrixLLT().diagonal().sum())) {
    return true;
  }
  constexpr double kRounding = 1e-9;
  Matrix scaled = m;
  for (int i = 0; i < m.rows(); ++i) {
    if (m(i, i) < 0.0) return false;
    if (m(i, i) == 0.0) {
      if (!m.row(i).isZero(0.0)) return false;
      continue;
    }
    const double scale = 1.0 / std::sqrt(m(i, i));
    scaled.row(i) *= scale;
    scaled.col(i) *= scale;
  }
  // No entry of a semi-definite matrix with unit diagonal exceeds 1.
  if (!scaled.allFinite() || scaled.cwiseAbs().maxCoeff() > 1.0 + kRounding) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(scaled, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] >= -kRounding;
}

/// Logarithm of the determinant of a positive semi-definite matrix; -inf if singular.
template <class Matrix>
double log_determinant(const Matrix& m) {
  const Eigen::LLT<Matrix> cholesky(m);
  return cholesky.info() == Eigen::Success ? log_determinant(cholesky) : -INFINITY;
}

}  // namespace isotherm::slam::detail
