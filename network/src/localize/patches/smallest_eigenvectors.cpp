#include "localize/patches/smallest_eigenvectors.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::network::detail {
namespace {

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& block) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(block);
  return qr.householderQ() * Eigen::MatrixXd::Identity(block.rows(), block.cols());
}

}  // namespace

Eigen::MatrixXd smallest_eigenvectors(spectral::BlockCholesky& matrix, int count) {
  constexpr int kSpare = 4;
  constexpr int kMostIterations = 60;
  constexpr double kTolerance = 1e-8;  // relative change of the sum of the eigenvalues
  constexpr double kShift = 1e-9;      // of the largest diagonal entry
  const auto n = matrix.size();
  const double norm = matrix.diagonal().maxCoeff();
  if (!matrix.factorise(Eigen::VectorXd::Constant(n, kShift * norm))) {
    throw NumericalError("synchronisation", "the factorisation broke down");
  }

  Random random(1);
  Eigen::MatrixXd block(n, std::min<Eigen::Index>(n, count + kSpare));
  for (auto& value : block.reshaped()) value = random.normal();
  block = orthonormal(block);
  Eigen::MatrixXd product(n, block.cols());
  double last = 0.0;
  for (int k = 0; k < kMostIterations; ++k) {
    block = orthonormal(matrix.solve(block));
    for (Eigen::Index c = 0; c < block.cols(); ++c) product.col(c) = matrix.multiply(block.col(c));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(block.transpose() * product);
    block = block * ritz.eigenvectors();
    const double sum = ritz.eigenvalues().head(count).sum();
    if (std::abs(sum - last) <= kTolerance * std::max(sum, 1e-6 * norm)) break;
    last = sum;
  }
  return block.leftCols(count);
}

}  // namespace isotherm::network::detail
