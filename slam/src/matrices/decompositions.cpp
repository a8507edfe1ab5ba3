#include "matrices/decompositions.hpp"

namespace Eigen {

template LLT<Matrix3d>& LLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);
template LLT<Matrix<double, 6, 6>>& LLT<Matrix<double, 6, 6>>::compute(
    const EigenBase<Matrix<double, 6, 6>>&);
template void PartialPivLU<Matrix3d>::compute();
template void PartialPivLU<Matrix<double, 6, 6>>::compute();
template SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
template SelfAdjointEigenSolver<Matrix<double, 6, 6>>&
SelfAdjointEigenSolver<Matrix<double, 6, 6>>::compute(const EigenBase<Matrix<double, 6, 6>>&, int);

}  // namespace Eigen
