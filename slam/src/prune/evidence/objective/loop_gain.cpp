#include "prune/evidence/objective/loop_gain.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/evidence/objective/student.hpp"

namespace isotherm::slam::detail {
namespace {

// A share of redundancy below this is rounding: only the loop itself measures there.
constexpr double kLeastShare = 1e-6;
constexpr int kMostSteps = 8;
constexpr double kSettled = 0.01;  // of a log weight

}  // namespace

template <class Pose>
Prediction<Pose> predict(const typename Pose::Tangent& r, const typename Pose::Matrix& C) {
  const typename Pose::Matrix J = residual_jacobian<Pose>(r);
  return {r, J * C * J.transpose()};
}

// Along the principal directions of what all know of it in units of its own measurement: without
// the loop, a residual is 1 / share times as long and as uncertain.
template <class Pose>
Prediction<Pose> predict_without(const typename Pose::Tangent& r, const typename Pose::Matrix& C,
                                 const typename Pose::Matrix& own) {
  using Matrix = typename Pose::Matrix;
  using Tangent = typename Pose::Tangent;
  const Eigen::LLT<Matrix> root(own);
  const Matrix half = root.matrixL().solve(predict<Pose>(r, C).P);
  const Matrix known = root.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix> redundancy(Matrix::Identity() - known);
  const Tangent wider = redundancy.eigenvalues().cwiseMax(kLeastShare).cwiseInverse();
  const Matrix axes = root.matrixL() * redundancy.eigenvectors();
  const Tangent along = redundancy.eigenvectors().transpose() * root.matrixL().solve(r);
  const Tangent others = (wider.array() - 1.0).max(0.0);
  return {axes * wider.cwiseProduct(along), axes * others.asDiagonal() * axes.transpose()};
}

// The loop's weight and its fitted residual depend on each other.
template <class Pose>
LoopGain loop_gain(const Prediction<Pose>& prediction, const typename Pose::Matrix& own,
                   double nu) {
  using Matrix = typename Pose::Matrix;
  using Tangent = typename Pose::Tangent;
  const auto& [r, P] = prediction;
  const Eigen::LLT<Matrix> root(own);
  const double deficit = laplace_deficit(nu, Pose::kDof);
  LoopGain gain;
  double weight = 1.0;
  for (int step = 0; step < kMostSteps; ++step) {
    const Matrix weighted = own / weight;
    const Eigen::LLT<Matrix> sum(weighted + P);
    const Tangent pull = sum.solve(r);
    const Tangent fitted = weighted * pull;
    const double fitted_chi2 = fitted.dot(root.solve(fitted));
    if (step == 0) gain.chi2 = r.dot(pull);
    gain.log_density = log_student(fitted_chi2, nu, Pose::kDof) - 0.5 * pull.dot(P * pull) -
                       0.5 * (log_determinant(sum) + Pose::kDof * std::log(weight)) +
                       deficit * sum.solve(P).trace() / Pose::kDof;
    const double next = student_weight(fitted_chi2, nu, Pose::kDof);
    const double change = std::abs(std::log(next / weight));
    weight = next;
    if (change < kSettled) break;
  }
  return gain;
}

template Prediction<Pose2> predict(const Pose2::Tangent&, const Pose2::Matrix&);
template Prediction<Pose3> predict(const Pose3::Tangent&, const Pose3::Matrix&);
template Prediction<Pose2> predict_without(const Pose2::Tangent&, const Pose2::Matrix&,
                                           const Pose2::Matrix&);
template Prediction<Pose3> predict_without(const Pose3::Tangent&, const Pose3::Matrix&,
                                           const Pose3::Matrix&);
template LoopGain loop_gain(const Prediction<Pose2>&, const Pose2::Matrix&, double);
template LoopGain loop_gain(const Prediction<Pose3>&, const Pose3::Matrix&, double);

}  // namespace isotherm::slam::detail
