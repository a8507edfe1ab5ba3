#include "prune/consensus/objective/loop_gain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "matrices/decompositions.hpp"
#include "prune/consensus/constants.hpp"
#include "prune/consensus/estimate/log_normal.hpp"

namespace isotherm::slam::detail {
namespace {

// A share of redundancy below this is rounding (3e-6 where odometry errs 1e7 times as much, in
// variance): only the loop itself measures there.
constexpr double kLeastShare = 1e-5;

// Of the log of a factor: less is none, and from node to node of the integral.
constexpr double kNoDeviation = 0.1;
constexpr double kNodeStep = 0.7;

// Nodes on either side for the integral over the log of a factor: to 2.8 deviations, by the
// trapezoidal rule.
constexpr int kNodes = 4;

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

// With these factors on the own covariance and on that of the others.
template <class Pose>
double log_density(const Prediction<Pose>& prediction, const Factors& own,
                   const Factors& odometry) {
  const auto& [r, variance, log_sigma] = prediction;
  Nodes by_odometry = odometry.log_weight;
  for (Eigen::Index i = 0; i < odometry.value.size(); ++i) {
    const typename Pose::Tangent others = odometry.value[i] * variance;
    by_odometry[i] += log_sum_of(own.log_weight + log_fit<Pose>(r, others, own.value));
  }
  return log_sum_of(by_odometry) - 0.5 * (log_sigma + Pose::kDof * kLog2Pi);
}

/// The density of a loop that errs by some factor times Sigma. Axes are found once, and only where
/// there is something to integrate over, or rounding leaves the others a negative variance.
template <class Pose>
class Density {
 public:
  Density(const Belief<Pose>& others, const typename Pose::Matrix& Sigma, const Factors& odometry)
      : others_(others), Sigma_(Sigma), odometry_(odometry) {}

  double log_at(const Factors& own) {
    if (!axes_ && own.value.size() == 1 && odometry_.value.size() == 1) {
      const auto factor = variance(own.value[0]);
      if (factor.info() == Eigen::Success) return log_normal<Pose>(others_.r, factor);
    }
    if (!axes_) axes_ = predict<Pose>(others_, Sigma_);
    return log_density(*axes_, own, odometry_);
  }

  double chi2(double own) const {
    if (!axes_) return others_.r.dot(variance(own).solve(others_.r));
    return (axes_->r.array().square() / (axes_->variance.array() + own)).sum();
  }

 private:
  Eigen::LLT<typename Pose::Matrix> variance(double own) const {
    const typename Pose::Matrix all = others_.P + own * Sigma_;
    return Eigen::LLT<typename Pose::Matrix>(all);
  }

  const Belief<Pose>& others_;
  const typename Pose::Matrix& Sigma_;
  const Factors& odometry_;
  std::optional<Prediction<Pose>> axes_;
};

}  // namespace

template <class Pose>
Prediction<Pose> predict(const Belief<Pose>& others, const typename Pose::Matrix& Sigma) {
  using Matrix = typename Pose::Matrix;
  const Eigen::LLT<Matrix> root(Sigma);
  const Matrix half = root.matrixL().solve(others.P);
  const Matrix known = root.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(known);
  return {axes.eigenvectors().transpose() * root.matrixL().solve(others.r),
          axes.eigenvalues().cwiseMax(0.0), log_determinant(root)};
}

// With Omega = L L' and M = I - L' P L the others leave P + P L M^-1 L' P, and the residual
// against them is r + P L M^-1 L' r (Woodbury). Where nearly nothing is redundant, along the axes
// of L' P L: where all leave the variance v, the others leave v / (1 - v), and the residual is as
// many times as long. No eigenvalue of M is more than 1, and so none less than its determinant.
template <class Pose>
Belief<Pose> without(const Belief<Pose>& with, const typename Pose::Matrix& Omega) {
  using Matrix = typename Pose::Matrix;
  const Eigen::LLT<Matrix> root(Omega);
  const Matrix L = root.matrixL();
  const Matrix fitted = L.transpose() * with.P * L;
  const Matrix unfitted = Matrix::Identity() - fitted;
  const Eigen::LLT<Matrix> rest(unfitted);
  if (rest.info() == Eigen::Success && log_determinant(rest) > std::log(kLeastShare)) {
    const Matrix half = rest.matrixL().solve(L.transpose() * with.P);
    const typename Pose::Tangent own = rest.matrixL().solve(L.transpose() * with.r);
    return {with.r + half.transpose() * own, with.P + half.transpose() * half};
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(fitted);
  const Matrix to_axes = axes.eigenvectors().transpose() * L.transpose();
  const typename Pose::Tangent v = axes.eigenvalues().cwiseMax(0.0);
  const typename Pose::Tangent redundancy = (1.0 - v.array()).max(kLeastShare);
  const Matrix back = root.matrixU().solve(axes.eigenvectors());
  const typename Pose::Tangent r = (to_axes * with.r).cwiseQuotient(redundancy);
  const typename Pose::Tangent left = v.cwiseQuotient(redundancy);
  return {back * r, back * left.asDiagonal() * back.transpose()};
}

template <class Pose>
typename Pose::Tangent residual_with(const Belief<Pose>& others,
                                     const typename Pose::Matrix& Omega) {
  using Matrix = typename Pose::Matrix;
  return (Matrix::Identity() + others.P * Omega).partialPivLu().solve(others.r);
}

template <class Pose>
LoopGain loop_gain(const Belief<Pose>& others, const OwnError<Pose>& own,
                   const ScaleMixture& mixture, const CovarianceScale& deviation) {
  const Factors odometry = factors(deviation.odometry);
  const Factors learnt_scale = factors(deviation.loops);
  Density<Pose> learnt(others, own.learnt, odometry);
  ByScale density;
  density.fill(kNever);
  for (std::size_t j = 0; j < kAsStated; ++j) {
    if (!mixture.has(j)) continue;
    const Factors scales{mixture.scale * mixture.relative[j] * learnt_scale.value,
                         learnt_scale.log_weight};
    density[j] = mixture.log_share[j] + learnt.log_at(scales);
  }
  if (mixture.has(kAsStated)) {
    Density<Pose> stated(others, own.stated, odometry);
    const Factors exact{Nodes::Ones(1), Nodes::Zero(1)};
    density[kAsStated] = mixture.log_share[kAsStated] + stated.log_at(exact);
  }
  LoopGain gain;
  gain.log_density = log_sum_of(Nodes::Map(density.data(), kScaleCount));
  gain.chi2 = learnt.chi2(mixture.scale);
  gain.weight = error_scale(mixture, density).weight;
  return gain;
}

template Prediction<Pose2> predict(const Belief<Pose2>&, const Pose2::Matrix&);
template Belief<Pose2> without(const Belief<Pose2>&, const Pose2::Matrix&);
template Pose2::Tangent residual_with(const Belief<Pose2>&, const Pose2::Matrix&);
template LoopGain loop_gain(const Belief<Pose2>&, const OwnError<Pose2>&, const ScaleMixture&,
                            const CovarianceScale&);
template Prediction<Pose3> predict(const Belief<Pose3>&, const Pose3::Matrix&);
template Belief<Pose3> without(const Belief<Pose3>&, const Pose3::Matrix&);
template Pose3::Tangent residual_with(const Belief<Pose3>&, const Pose3::Matrix&);
template LoopGain loop_gain(const Belief<Pose3>&, const OwnError<Pose3>&, const ScaleMixture&,
                            const CovarianceScale&);

}  // namespace isotherm::slam::detail
