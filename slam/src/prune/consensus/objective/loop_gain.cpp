#include "prune/consensus/objective/loop_gain.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/consensus/objective/log_sum.hpp"

namespace isotherm::slam::detail {
namespace {

// A share of redundancy below this is rounding: only the loop itself measures there.
constexpr double kLeastShare = 1e-6;

// The integral over the log of a factor, in deviations: the trapezoidal rule to 2.8 of them.
constexpr double kNoDeviation = 0.1;
constexpr int kNodes = 4;  // on either side
constexpr double kNodeStep = 0.7;

struct Factor {
  double value = 1.0;
  double log_weight = 0.0;
};

std::vector<Factor> factors(double deviation) {
  const int nodes = deviation < kNoDeviation ? 0 : kNodes;
  double sum = 0.0;
  std::vector<Factor> result;
  for (int i = -nodes; i <= nodes; ++i) {
    const double x = kNodeStep * i;
    result.push_back({std::exp(deviation * x), -0.5 * x * x});
    sum += std::exp(-0.5 * x * x);
  }
  for (Factor& factor : result) factor.log_weight -= std::log(sum);
  return result;
}

// log N(r; variance + own) but for a constant.
template <class Pose>
double log_fit(const typename Pose::Tangent& r, const typename Pose::Tangent& variance,
               double own) {
  const typename Pose::Tangent S = variance.array() + own;
  return -0.5 * (S.array().log().sum() + (r.array().square() / S.array()).sum());
}

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
Prediction<Pose> at_best(Prediction<Pose> prediction, double own) {
  const typename Pose::Tangent likeliest = (prediction.r.array().square() - own).max(0.0);
  prediction.variance = prediction.variance.cwiseMin(likeliest);
  return prediction;
}

template <class Pose>
LoopGain loop_gain(const Prediction<Pose>& prediction, const ScaleMixture& mixture,
                   const CovarianceScale& deviation) {
  const auto& [r, variance, log_sigma] = prediction;
  const auto most = factors(deviation.loops);
  ByScale density;
  density.fill(-std::numeric_limits<double>::infinity());
  const auto add = [&density](std::size_t scale, double log_term) {
    density[scale] = log_sum(density[scale], log_term);
  };
  for (const Factor& odometry : factors(deviation.odometry)) {
    const typename Pose::Tangent others = odometry.value * variance;
    for (const Factor& own : most) {
      add(0, mixture.log_share[0] + odometry.log_weight + own.log_weight +
                 log_fit<Pose>(r, others, own.value * mixture.scale));
    }
    add(1, mixture.log_share[1] + odometry.log_weight +
               log_fit<Pose>(r, others, mixture.scale * mixture.relative[1]));
  }
  LoopGain gain;
  gain.log_density = log_sum(density[0], density[1]) - 0.5 * (log_sigma + Pose::kDof * kLog2Pi);
  gain.chi2 = (r.array().square() / (variance.array() + mixture.scale)).sum();
  gain.weight = error_scale(mixture, density, Pose::kDof).weight;
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
template Prediction<Pose2> at_best(Prediction<Pose2>, double);
template Prediction<Pose3> at_best(Prediction<Pose3>, double);
template LoopGain loop_gain(const Prediction<Pose2>&, const ScaleMixture&, const CovarianceScale&);
template LoopGain loop_gain(const Prediction<Pose3>&, const ScaleMixture&, const CovarianceScale&);

}  // namespace isotherm::slam::detail
