#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

// Of the matrices of poses, 3 x 3 and 6 x 6, compiled once: every source that instantiates them for
// itself takes seconds to do so. Who uses none of these includes Eigen's own headers.
extern template class Eigen::LLT<Eigen::Matrix<double, 3, 3>>;
extern template class Eigen::LLT<Eigen::Matrix<double, 6, 6>>;
extern template class Eigen::PartialPivLU<Eigen::Matrix<double, 3, 3>>;
extern template class Eigen::PartialPivLU<Eigen::Matrix<double, 6, 6>>;
extern template class Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 3, 3>>;
extern template class Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>;

namespace isotherm::slam::detail {

/// Logarithm of the determinant of a matrix, by its factor.
template <class Matrix>
double log_determinant(const Eigen::LLT<Matrix>& factor) {
  return 2.0 * factor.matrixLLT().diagonal().array().log().sum();
}

}  // namespace isotherm::slam::detail
