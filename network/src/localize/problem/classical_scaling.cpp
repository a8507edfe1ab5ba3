#include "localize/problem/classical_scaling.hpp"

namespace isotherm::network::detail {

Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> classical_scaling(const Eigen::MatrixXd& squared) {
  const Eigen::RowVectorXd means = squared.colwise().mean();
  Eigen::MatrixXd inner = squared;
  inner.rowwise() -= means;
  inner.colwise() -= means.transpose();
  inner.array() += means.mean();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(-0.5 * inner);
}

}  // namespace isotherm::network::detail
