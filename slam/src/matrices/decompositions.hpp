#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

// Of the matrices of poses, 3 x 3 and 6 x 6, compiled once: every source that instantiates them for
// itself takes seconds to do so, as it does for those of expressions. Who uses none of these
// includes Eigen's own headers.
namespace Eigen {

extern template LLT<Matrix3d>& LLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);
extern template LLT<Matrix<double, 6, 6>>& LLT<Matrix<double, 6, 6>>::compute(
    const EigenBase<Matrix<double, 6, 6>>&);
extern template void PartialPivLU<Matrix3d>::compute();
extern template void PartialPivLU<Matrix<double, 6, 6>>::compute();
extern template SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
extern template SelfAdjointEigenSolver<Matrix<double, 6, 6>>&
SelfAdjointEigenSolver<Matrix<double, 6, 6>>::compute(const EigenBase<Matrix<double, 6, 6>>&, int);

}  // namespace Eigen

namespace isotherm::slam::detail {

/// Logarithm of the determinant of a matrix, by its factor.
template <class Matrix>
double log_determinant(const Eigen::LLT<Matrix>& factor) {
  return 2.0 * factor.matrixLLT().diagonal().array().log().sum();
}

}  // namespace isotherm::slam::detail
