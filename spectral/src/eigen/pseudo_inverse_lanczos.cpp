#include "eigen/pseudo_inverse_lanczos.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Eigenvalues>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr std::uint64_t kSeed = 20170509;  // any fixed start vector does
constexpr double kRitzTolerance = 1e-13;   // on residuals, relative to the Ritz value
constexpr Index kSmallestBasis = 24;

void orthogonalise(Eigen::VectorXd& x, const Eigen::Ref<const Eigen::MatrixXd>& basis,
                   Eigen::Ref<Eigen::VectorXd> coefficients) {
  coefficients.setZero();
  for (int pass = 0; pass < 2; ++pass) {  // twice is enough (Giraud et al. 2005)
    const Eigen::VectorXd part = basis.transpose() * x;
    x.noalias() -= basis * part;
    coefficients += part;
  }
}

}  // namespace

/// An orthonormal basis with the operator's projection onto it, and the
/// direction that comes next.
struct PseudoInverseLanczos::Basis {
  Eigen::MatrixXd vectors;     // n x capacity
  Eigen::MatrixXd projection;  // capacity x capacity
  Index used = 0;
  Eigen::VectorXd next;   // unit vector
  double coupling = 0.0;  // of `next` to the last vector; 0 if the space was invariant
};

PseudoInverseLanczos::PseudoInverseLanczos(const Laplacian& laplacian, const EigenOptions& options)
    : solver_(laplacian),
      size_(laplacian.size()),
      null_count_(laplacian.components().count),
      options_(options),
      random_(kSeed) {}

Eigen::VectorXd PseudoInverseLanczos::multiply(const Eigen::VectorXd& x,
                                               const Eigen::MatrixXd& locked) {
  ++solves_;
  if (options_.progress && !options_.progress({"eigenpairs", solves_, 0})) throw Cancelled();
  Eigen::VectorXd y = solver_.solve(x);
  if (locked.cols() > 0) y -= locked * (locked.transpose() * y).eval();
  return y;
}

Eigen::VectorXd PseudoInverseLanczos::random_direction(const Basis& basis,
                                                       const Eigen::MatrixXd& locked) {
  Eigen::VectorXd direction(size_);
  for (Index v = 0; v < size_; ++v) direction[v] = random_.uniform(-1.0, 1.0);
  for (int pass = 0; pass < 2; ++pass) {
    solver_.remove_null_space(direction);
    direction -= locked * (locked.transpose() * direction).eval();
    const auto used = basis.vectors.leftCols(basis.used);
    direction -= used * (used.transpose() * direction).eval();
  }
  return direction.normalized();
}

/// Lanczos steps until the basis has `size` vectors.
void PseudoInverseLanczos::extend(Basis& basis, Index size, const Eigen::MatrixXd& locked) {
  constexpr double kBreakdown = 64.0 * std::numeric_limits<double>::epsilon();
  Eigen::VectorXd coefficients(size);
  while (basis.used < size) {
    const Index column = basis.used++;
    basis.vectors.col(column) = basis.next;
    Eigen::VectorXd product = multiply(basis.next, locked);
    const double length = product.norm();
    orthogonalise(product, basis.vectors.leftCols(basis.used), coefficients.head(basis.used));
    basis.projection.col(column).head(basis.used) = coefficients.head(basis.used);
    basis.projection.row(column).head(basis.used) = coefficients.head(basis.used).transpose();
    basis.coupling = product.norm();
    if (basis.coupling > kBreakdown * length) {
      basis.next = product / basis.coupling;
    } else {
      basis.coupling = 0.0;
      basis.next = random_direction(basis, locked);
    }
  }
}

PseudoInverseLanczos::Pairs PseudoInverseLanczos::largest(Index count,
                                                          const Eigen::MatrixXd& locked) {
  const Index complement = size_ - null_count_ - static_cast<Index>(locked.cols());
  count = std::min(count, complement);
  if (count <= 0) return {Eigen::VectorXd(0), Eigen::MatrixXd(size_, 0)};
  const Index capacity = std::min(complement, std::max(2 * count + 2, kSmallestBasis));

  Basis basis;
  basis.vectors.resize(size_, capacity);
  basis.projection.setZero(capacity, capacity);
  basis.next = random_direction(basis, locked);
  for (int restart = 0;; ++restart) {
    extend(basis, capacity, locked);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(basis.projection);
    const Eigen::VectorXd values = ritz.eigenvalues().reverse();
    const Eigen::MatrixXd rotation = ritz.eigenvectors().rowwise().reverse();
    const Eigen::ArrayXd residuals =
        basis.coupling * rotation.row(capacity - 1).head(count).cwiseAbs().transpose().array();
    const bool converged = (residuals <= kRitzTolerance * values.head(count).array()).all();
    if (converged || capacity == complement || restart == options_.max_restarts) {
      return {values.head(count).cwiseInverse(), basis.vectors * rotation.leftCols(count)};
    }
    const Index kept = count + (capacity - count) / 2;
    basis.vectors.leftCols(kept) = (basis.vectors * rotation.leftCols(kept)).eval();
    basis.projection.setZero();
    basis.projection.diagonal().head(kept) = values.head(kept);
    basis.used = kept;
  }
}

}  // namespace isotherm::spectral::detail
