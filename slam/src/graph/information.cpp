#include "isotherm/slam/graph/information.hpp"

#include <algorithm>

#include "isotherm/base/error.hpp"
#include "matrices/decompositions.hpp"

namespace isotherm::slam {
namespace {

constexpr double kWidestDiagonal = 1e12;    // ratio of two entries, in any units
constexpr double kLeastCorrelated = 1e-12;  // eigenvalue of the matrix with unit diagonal

// The square roots of the diagonal, none of them 0 or too small beside the largest one.
template <int Dof>
Eigen::Matrix<double, Dof, 1> deviations(const Eigen::Matrix<double, Dof, Dof>& information) {
  const double largest = std::max(information.diagonal().maxCoeff(), 0.0);
  return information.diagonal().cwiseMax(largest / kWidestDiagonal).cwiseSqrt();
}

template <class Matrix>
double one_norm(const Matrix& matrix) {
  return matrix.cwiseAbs().colwise().sum().maxCoeff();
}

// With unit diagonal, so that metres and radians do not matter.
template <int Dof>
Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dof, Dof>> scaled_eigen(
    const Eigen::Matrix<double, Dof, Dof>& information,
    const Eigen::Matrix<double, Dof, 1>& scale) {
  const Eigen::Matrix<double, Dof, 1> inverse = scale.cwiseInverse();
  const Eigen::Matrix<double, Dof, Dof> scaled =
      inverse.asDiagonal() * information * inverse.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dof, Dof>>(scaled);
}

}  // namespace

template <int Dof>
Eigen::Matrix<double, Dof, Dof> covariance_from_information(
    const Eigen::Matrix<double, Dof, Dof>& information) {
  using Matrix = Eigen::Matrix<double, Dof, Dof>;
  if (!information.allFinite()) {
    throw NumericalError("covariance", "information matrix with an entry that is not finite");
  }
  // Well-conditioned matrices, nearly all in practice, need no eigenvectors.
  const Eigen::LLT<Matrix> factor(information);
  if (factor.info() == Eigen::Success &&
      information.diagonal().minCoeff() > 1.0 / kUnknownVariance) {
    const Matrix inverse = factor.solve(Matrix::Identity());
    if (one_norm(information) * one_norm(inverse) < 1e10) return inverse;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(information);
  const double largest = std::max(eigen.eigenvalues().cwiseAbs().maxCoeff(), 0.0);
  const double floor = std::max(1.0 / kUnknownVariance, largest * 1e-14);
  Eigen::Matrix<double, Dof, 1> variances;
  for (int k = 0; k < Dof; ++k) {
    const double value = eigen.eigenvalues()[k];
    variances[k] = value > floor ? 1.0 / value : kUnknownVariance;
  }
  return eigen.eigenvectors() * variances.asDiagonal() * eigen.eigenvectors().transpose();
}

template <int Dof>
bool is_usable_information(const Eigen::Matrix<double, Dof, Dof>& information) {
  if (information.isZero(0.0)) return true;
  const auto diagonal = information.diagonal();
  if (!(diagonal.minCoeff() * kWidestDiagonal > diagonal.maxCoeff())) return false;
  const Eigen::LLT<Eigen::Matrix<double, Dof, Dof>> factor(information);
  if (factor.info() == Eigen::Success && factor.rcond() > 1e-9) return true;  // nearly all
  const auto eigen = scaled_eigen<Dof>(information, deviations<Dof>(information));
  return eigen.eigenvalues()[0] > kLeastCorrelated;
}

template <int Dof>
Eigen::Matrix<double, Dof, Dof> usable_information(
    const Eigen::Matrix<double, Dof, Dof>& information) {
  // Well within what is usable, for the sake of long chains.
  constexpr double kMargin = 1e3;
  using Vector = Eigen::Matrix<double, Dof, 1>;
  if (!information.allFinite()) {
    throw NumericalError("information", "matrix with an entry that is not finite");
  }
  const Vector scale = deviations<Dof>(information);
  const auto eigen = scaled_eigen<Dof>(information, scale);
  const Vector raised = eigen.eigenvalues().cwiseMax(kMargin * kLeastCorrelated);
  const double known = (information.diagonal().array() > 0.0)
                           .select(information.diagonal(), information.diagonal().maxCoeff())
                           .minCoeff();
  const Vector lowered = scale.cwiseMin(std::sqrt(known * kWidestDiagonal / kMargin));
  return lowered.asDiagonal() * eigen.eigenvectors() * raised.asDiagonal() *
         eigen.eigenvectors().transpose() * lowered.asDiagonal();
}

template bool is_usable_information(const Eigen::Matrix<double, 3, 3>&);
template bool is_usable_information(const Eigen::Matrix<double, 6, 6>&);
template Eigen::Matrix<double, 3, 3> usable_information(const Eigen::Matrix<double, 3, 3>&);
template Eigen::Matrix<double, 6, 6> usable_information(const Eigen::Matrix<double, 6, 6>&);
template Eigen::Matrix<double, 3, 3> covariance_from_information(
    const Eigen::Matrix<double, 3, 3>&);
template Eigen::Matrix<double, 6, 6> covariance_from_information(
    const Eigen::Matrix<double, 6, 6>&);

}  // namespace isotherm::slam
