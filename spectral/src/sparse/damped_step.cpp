#include "isotherm/spectral/sparse/damped_step.hpp"

#include "isotherm/base/error.hpp"

namespace isotherm::spectral {

Eigen::VectorXd damping_scale(const BlockCholesky& matrix) {
  const Eigen::VectorXd diagonal = matrix.diagonal();
  const double largest = diagonal.size() > 0 ? diagonal.maxCoeff() : 0.0;
  return diagonal.cwiseMax(largest > 0.0 ? 1e-12 * largest : 1.0);
}

Eigen::MatrixXd solve_least_damped(BlockCholesky& matrix, const Eigen::MatrixXd& rhs) {
  bool definite = matrix.factorise();
  if (!definite) {
    const Eigen::VectorXd scale = damping_scale(matrix);
    for (double damping = 1e-12; !definite && damping <= 1.0; damping *= 100.0) {
      definite = matrix.factorise(damping * scale);
    }
  }
  if (!definite) throw NumericalError("cholesky", "the normal equations are not definite");
  return matrix.solve(rhs);
}

}  // namespace isotherm::spectral
