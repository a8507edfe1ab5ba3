#include "prune/consensus/estimate/prediction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace isotherm::slam::detail {
namespace {

// A share of redundancy below this is rounding: only the loop itself measures there.
constexpr double kLeastShare = 1e-6;

// An accepted loop in units of its own measurement, along the principal directions of
// what the others know of it.
template <class Pose>
struct Fit {
  using Matrix = typename Pose::Matrix;
  using Tangent = typename Pose::Tangent;

  Fit(const Link<Pose>& loop, const Tangent& r, const Matrix& C, double loop_scale)
      : root(loop.covariance * loop_scale) {
    const Matrix jacobian = residual_jacobian<Pose>(r);
    const Matrix fitted = jacobian * C * jacobian.transpose();
    const Matrix half = root.matrixL().solve(fitted);
    const Matrix known = root.matrixL().solve(half.transpose());
    const Eigen::SelfAdjointEigenSolver<Matrix> redundancy(Matrix::Identity() - known);
    directions = redundancy.eigenvectors();
    share = redundancy.eigenvalues();
    along = directions.transpose() * root.matrixL().solve(r);
  }

  Eigen::LLT<Matrix> root;
  Matrix directions;
  Tangent share;  // of the residual that the other loops leave to this one
  Tangent along;  // the residual
};

}  // namespace

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
  const Fit<Pose> fit(loop, r, C, loop_scale);
  double chi2 = 0.0;
  for (int d = 0; d < Pose::kDof; ++d) {
    if (fit.share[d] > kLeastShare) chi2 += fit.along[d] * fit.along[d] / fit.share[d];
  }
  return chi2;
}

// Without the loop itself, a direction's residual is 1 / share times as long and its
// variance 1 / share times that of the measurement.
template <class Pose>
Evidence weigh_held_out(const Link<Pose>& loop, const typename Pose::Tangent& r,
                        const typename Pose::Matrix& C, double loop_scale,
                        const MapVolume<Pose>& map) {
  using Tangent = typename Pose::Tangent;
  const Fit<Pose> fit(loop, r, C, loop_scale);
  const Tangent wider = fit.share.cwiseMax(kLeastShare).cwiseInverse();
  const typename Pose::Matrix axes = fit.root.matrixL() * fit.directions;
  return weigh<Pose>(axes * wider.cwiseProduct(fit.along),
                     axes * wider.asDiagonal() * axes.transpose(), map);
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
template Evidence weigh_held_out(const Link<Pose2>&, const Pose2::Tangent&, const Pose2::Matrix&,
                                 double, const MapVolume<Pose2>&);
template Pose2::Matrix sharpened(const Link<Pose2>&, const Pose2::Tangent&, const Pose2::Matrix&,
                                 double);
template Evidence weigh_prediction(const Link<Pose3>&, const Pose3::Tangent&, const Pose3::Matrix&,
                                   double, const MapVolume<Pose3>&);
template double fitted_chi2(const Link<Pose3>&, const Pose3::Tangent&, const Pose3::Matrix&,
                            double);
template Evidence weigh_held_out(const Link<Pose3>&, const Pose3::Tangent&, const Pose3::Matrix&,
                                 double, const MapVolume<Pose3>&);
template Pose3::Matrix sharpened(const Link<Pose3>&, const Pose3::Tangent&, const Pose3::Matrix&,
                                 double);

}  // namespace isotherm::slam::detail
