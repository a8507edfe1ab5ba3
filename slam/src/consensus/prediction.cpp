#include "prediction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace isotherm::slam::detail {

template <class Pose>
Evidence weigh_prediction(const Link<Pose>& loop, const typename Pose::Tangent& r,
                          const typename Pose::Matrix& C, double loop_scale,
                          const MapVolume<Pose>& map) {
  using Matrix = typename Pose::Matrix;
  const Matrix jacobian = residual_jacobian<Pose>(r);
  const Matrix spread = loop.covariance * loop_scale + jacobian * C * jacobian.transpose();
  return weigh<Pose>(r, spread, map);
}

template <class Pose>
double fitted_chi2(const Link<Pose>& loop, const typename Pose::Tangent& r,
                   const typename Pose::Matrix& C, double loop_scale) {
  using Matrix = typename Pose::Matrix;
  using Tangent = typename Pose::Tangent;
  const Matrix jacobian = residual_jacobian<Pose>(r);
  const Matrix fitted = jacobian * C * jacobian.transpose();
  const Eigen::LLT<Matrix> root(loop.covariance * loop_scale);
  const Tangent whitened = root.matrixL().solve(r);
  const Matrix half = root.matrixL().solve(fitted);
  const Matrix known = root.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix> redundancy(Matrix::Identity() - known);
  const Tangent along = redundancy.eigenvectors().transpose() * whitened;
  double chi2 = 0.0;
  for (int d = 0; d < Pose::kDof; ++d) {
    const double share = redundancy.eigenvalues()[d];
    if (share > 1e-6) chi2 += along[d] * along[d] / share;
  }
  return chi2;
}

template <class Pose>
typename Pose::Matrix sharpened(const Link<Pose>& loop, const typename Pose::Tangent& r,
                                const typename Pose::Matrix& C, double loop_scale) {
  using Matrix = typename Pose::Matrix;
  const Matrix jacobian = residual_jacobian<Pose>(r);
  const Matrix across = jacobian * C;
  const Matrix sum = across * jacobian.transpose() + loop.covariance * loop_scale;
  return C - across.transpose() * Eigen::LLT<Matrix>(sum).solve(across);
}

template Evidence weigh_prediction(const Link<Pose2>&, const Pose2::Tangent&, const Pose2::Matrix&,
                                   double, const MapVolume<Pose2>&);
template double fitted_chi2(const Link<Pose2>&, const Pose2::Tangent&, const Pose2::Matrix&,
                            double);
template Pose2::Matrix sharpened(const Link<Pose2>&, const Pose2::Tangent&, const Pose2::Matrix&,
                                 double);
template Evidence weigh_prediction(const Link<Pose3>&, const Pose3::Tangent&, const Pose3::Matrix&,
                                   double, const MapVolume<Pose3>&);
template double fitted_chi2(const Link<Pose3>&, const Pose3::Tangent&, const Pose3::Matrix&,
                            double);
template Pose3::Matrix sharpened(const Link<Pose3>&, const Pose3::Tangent&, const Pose3::Matrix&,
                                 double);

}  // namespace isotherm::slam::detail
