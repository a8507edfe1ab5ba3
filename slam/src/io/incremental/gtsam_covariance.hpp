#pragma once

#include "matrices/decompositions.hpp"

namespace isotherm::slam::detail {

/// The information of a covariance as GTSAM has it, which in space puts rotation first; one that is
/// found out as indefinite where it is no covariance.
template <class Matrix>
Matrix information_from_gtsam(const Matrix& covariance) {
  constexpr int kDof = Matrix::RowsAtCompileTime;
  constexpr int kFirst = kDof == 6 ? 3 : 0;
  Matrix ours;
  for (int row = 0; row < kDof; ++row) {
    for (int column = 0; column < kDof; ++column) {
      ours((row + kFirst) % kDof, (column + kFirst) % kDof) = covariance(row, column);
    }
  }
  const Matrix inverse = ours.inverse();
  if (!inverse.allFinite()) return -Matrix::Identity();
  return 0.5 * (inverse + inverse.transpose());
}

}  // namespace isotherm::slam::detail
