#include "prune/evidence/objective/loop_gain.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "prune/consensus/estimate/log_normal.hpp"

namespace isotherm::slam::detail {
namespace {

// A share of redundancy below this is rounding: only the loop itself measures there.
constexpr double kLeastShare = 1e-6;

}  // namespace

template <class Pose>
Prediction<Pose> predict(const typename Pose::Tangent& r, const typename Pose::Matrix& C,
                         const typename Pose::Matrix& Sigma) {
  using Matrix = typename Pose::Matrix;
  const Eigen::LLT<Matrix> root(Sigma);
  const Matrix J = residual_jacobian<Pose>(r);
  const Matrix half = root.matrixL().solve(J * C * J.transpose());
  const Matrix known = root.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(known);
  return {axes.eigenvectors().transpose() * root.matrixL().solve(r),
          axes.eigenvalues().cwiseMax(0.0), log_determinant(root)};
}

// Where all leave the variance v, the others leave v / (1 - precision v), and the residual against
// them is as many times as long.
template <class Pose>
Prediction<Pose> predict_without(const typename Pose::Tangent& r, const typename Pose::Matrix& C,
                                 const typename Pose::Matrix& Sigma, double precision) {
  Prediction<Pose> prediction = predict<Pose>(r, C, Sigma);
  for (int d = 0; d < Pose::kDof; ++d) {
    const double redundancy = std::max(1.0 - precision * prediction.variance[d], kLeastShare);
    prediction.r[d] /= redundancy;
    prediction.variance[d] /= redundancy;
  }
  return prediction;
}

template <class Pose>
LoopGain loop_gain(const Prediction<Pose>& prediction, const ScaleMixture& mixture) {
  const auto& [r, variance, log_sigma] = prediction;
  ByScale log_density;
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    const auto S = (variance.array() + mixture.scale * mixture.relative[j]).eval();
    log_density[j] =
        mixture.log_share[j] - 0.5 * ((r.array().square() / S).sum() + std::log(S.prod()));
  }
  const double most = *std::ranges::max_element(log_density);
  double sum = 0.0;
  for (const double value : log_density) sum += std::exp(value - most);
  LoopGain gain;
  gain.log_density = most + std::log(sum) - 0.5 * (log_sigma + Pose::kDof * kLog2Pi);
  gain.chi2 = (r.array().square() / (variance.array() + mixture.scale)).sum();
  gain.weight = error_scale(mixture, log_density, Pose::kDof).weight;
  return gain;
}

template Prediction<Pose2> predict(const Pose2::Tangent&, const Pose2::Matrix&,
                                   const Pose2::Matrix&);
template Prediction<Pose3> predict(const Pose3::Tangent&, const Pose3::Matrix&,
                                   const Pose3::Matrix&);
template Prediction<Pose2> predict_without(const Pose2::Tangent&, const Pose2::Matrix&,
                                           const Pose2::Matrix&, double);
template Prediction<Pose3> predict_without(const Pose3::Tangent&, const Pose3::Matrix&,
                                           const Pose3::Matrix&, double);
template LoopGain loop_gain(const Prediction<Pose2>&, const ScaleMixture&);
template LoopGain loop_gain(const Prediction<Pose3>&, const ScaleMixture&);

}  // namespace isotherm::slam::detail
