#include "isotherm/geometry/points/point_alignment.hpp"

#include <Eigen/SVD>

#include "isotherm/base/error.hpp"

namespace isotherm::geometry {

PointAlignment align_points(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to) {
  if (from.rows() != to.rows() || from.cols() != to.cols()) {
    throw InvalidArgument("to", "must have as many points and coordinates as 'from'");
  }
  PointAlignment result;
  result.rotation.setIdentity(from.rows(), from.rows());
  result.translation.setZero(from.rows());
  if (from.cols() == 0) return result;
  const Eigen::VectorXd centre_from = from.rowwise().mean();
  const Eigen::VectorXd centre_to = to.rowwise().mean();
  const Eigen::MatrixXd cross =
      (to.colwise() - centre_to) * (from.colwise() - centre_from).transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(
      cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  result.rotation = svd.matrixU() * svd.matrixV().transpose();
  result.translation = centre_to - result.rotation * centre_from;
  result.residual = (to - result.apply(from)).squaredNorm();
  result.certainty = svd.singularValues().minCoeff();
  return result;
}

}  // namespace isotherm::geometry
