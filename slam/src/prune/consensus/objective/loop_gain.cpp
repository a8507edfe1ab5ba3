#include "prune/consensus/objective/loop_gain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "prune/consensus/constants.hpp"
#include "prune/consensus/estimate/log_normal.hpp"

namespace isotherm::slam::detail {
namespace {

// A share of redundancy below this is rounding: only the loop itself measures there.
constexpr double kLeastShare = 1e-6;

// Of the log of a factor: less is none, and from node to node of the integral.
constexpr double kNoDeviation = 0.1;
constexpr double kNodeStep = 0.7;

using Nodes = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, 2 * kNodes + 1, 1>;

struct Factors {
  Nodes value;
  Nodes log_weight;
};

Factors factors(double deviation) {
  const int nodes = deviation < kNoDeviation ? 0 : kNodes;
  const Nodes x = Nodes::LinSpaced(2 * nodes + 1, -kNodeStep * nodes, kNodeStep * nodes);
  const Nodes log_density = -0.5 * x.square();
  return {(deviation * x).exp(), log_density - std::log(log_density.exp().sum())};
}

double log_sum_of(const Nodes& logs) {
  const double most = logs.maxCoeff();
  return most + std::log((logs - most).exp().sum());
}

// log N(r; variance + own) but for a constant, of each own.
template <class Pose>
Nodes log_fit(const typename Pose::Tangent& r, const typename Pose::Tangent& variance,
              const Nodes& own) {
  Nodes determinant = Nodes::Ones(own.size());
  Nodes chi2 = Nodes::Zero(own.size());
  for (int d = 0; d < Pose::kDof; ++d) {
    const Nodes S = variance[d] + own;
    determinant *= S;
    chi2 += r[d] * r[d] / S;
  }
  return -0.5 * (determinant.log() + chi2);
}

}  // namespace

template <class Pose>
Prediction<Pose> predict(const typename Pose::Tangent& r, const typename Pose::Matrix& P,
                         const typename Pose::Matrix& Sigma) {
  using Matrix = typename Pose::Matrix;
  const Eigen::LLT<Matrix> root(Sigma);
  const Matrix half = root.matrixL().solve(P);
  const Matrix known = root.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(known);
  return {axes.eigenvectors().transpose() * root.matrixL().solve(r),
          axes.eigenvalues().cwiseMax(0.0), log_determinant(root)};
}

// Where all leave the variance v, the others leave v / (1 - precision v), and the residual against
// them is as many times as long.
template <class Pose>
Prediction<Pose> predict_without(const typename Pose::Tangent& r, const typename Pose::Matrix& P,
                                 const typename Pose::Matrix& Sigma, double precision) {
  Prediction<Pose> prediction = predict<Pose>(r, P, Sigma);
  for (int d = 0; d < Pose::kDof; ++d) {
    const double redundancy = std::max(1.0 - precision * prediction.variance[d], kLeastShare);
    prediction.r[d] /= redundancy;
    prediction.variance[d] /= redundancy;
  }
  return prediction;
}

template <class Pose>
LoopGain loop_gain(const Prediction<Pose>& prediction, const ScaleMixture& mixture,
                   const CovarianceScale& deviation) {
  const auto& [r, variance, log_sigma] = prediction;
  const Factors odometry = factors(deviation.odometry);
  const Factors own = factors(deviation.loops);
  ByScale density;
  density.fill(kNever);
  for (std::size_t j = 0; j < kScaleCount; ++j) {
    if (!mixture.has(j)) continue;
    const Nodes own_variance = mixture.scale * mixture.relative[j] * own.value;
    Nodes by_odometry = odometry.log_weight;
    for (Eigen::Index i = 0; i < odometry.value.size(); ++i) {
      const typename Pose::Tangent others = odometry.value[i] * variance;
      by_odometry[i] += log_sum_of(own.log_weight + log_fit<Pose>(r, others, own_variance));
    }
    density[j] = mixture.log_share[j] + log_sum_of(by_odometry);
  }
  LoopGain gain;
  gain.log_density = log_sum_of(Nodes::Map(density.data(), kScaleCount)) -
                     0.5 * (log_sigma + Pose::kDof * kLog2Pi);
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
template LoopGain loop_gain(const Prediction<Pose2>&, const ScaleMixture&, const CovarianceScale&);
template LoopGain loop_gain(const Prediction<Pose3>&, const ScaleMixture&, const CovarianceScale&);

}  // namespace isotherm::slam::detail
