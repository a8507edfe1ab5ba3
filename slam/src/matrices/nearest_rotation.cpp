#include "matrices/nearest_rotation.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace isotherm::slam::detail {

NearestRotation nearest_rotation(const Eigen::MatrixXd& matrix) {
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(
      matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::VectorXd sign = Eigen::VectorXd::Ones(matrix.rows());
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) {
    sign[matrix.rows() - 1] = -1.0;
  }
  return {svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose(), svd.singularValues()};
}

}  // namespace isotherm::slam::detail
