#include "isotherm/slam/graph/information.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {

template <int Dof>
Eigen::Matrix<double, Dof, Dof> covariance_from_information(
    const Eigen::Matrix<double, Dof, Dof>& information) {
  using Matrix = Eigen::Matrix<double, Dof, Dof>;
  if (!information.allFinite()) {
    throw NumericalError("covariance", "information matrix with an entry that is not finite");
  }
  // Well-conditioned matrices, nearly all in practice, need no eigenvectors.
  const Eigen::LLT<Matrix> factor(information);
  if (factor.info() == Eigen::Success && factor.rcond() > 1e-10 &&
      information.diagonal().minCoeff() > 1.0 / kUnknownVariance) {
    return factor.solve(Matrix::Identity());
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(information);
  const double largest = std::max(eigen.eigenvalues().cwiseAbs().maxCoeff(), 0.0);
  const double floor = std::max(1.0 / kUnknownVariance, largest * 1e-14);
  Eigen::Matrix<double, Dof, 1> variances;
  for (int k = 0; k < Dof; ++k) {
    const double value = eigen.eigenvalues()[k];
    variances[k] = value > floor ? 1.0 / value : kUnknownVariance;
  }
  return eigen.eigenvectors() * variances.asDiagonal() * eigen.eigenvectors().transpose();
}

template Eigen::Matrix<double, 3, 3> covariance_from_information(
    const Eigen::Matrix<double, 3, 3>&);
template Eigen::Matrix<double, 6, 6> covariance_from_information(
    const Eigen::Matrix<double, 6, 6>&);

}  // namespace isotherm::slam
