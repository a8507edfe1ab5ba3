#include "eigen/pseudo_inverse_pairs.hpp"

#include <algorithm>
#include <stdexcept>

#include <Spectra/SymEigsSolver.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr std::uint64_t kSeed = 20170509;  // any fixed start vectors do
constexpr double kRitzTolerance = 1e-13;   // on residuals, relative to the Ritz value
constexpr Index kSmallestBasis = 24;
// Spectra's tridiagonal solver fails for some where nearly all eigenvalues are equal.
constexpr int kMostStarts = 5;

/// The pseudo-inverse on the complement of `locked`, as Spectra asks for it.
///
/// Null and locked vectors get the eigenvalue -1, not 0. Where all others are equal (complete
/// graphs) any start would else be an eigenvector, of which Spectra divides the rounding errors
/// by their size; and its tridiagonal solver may fail on rounding errors around 0.
class DeflatedInverse {
 public:
  using Scalar = double;

  DeflatedInverse(LaplacianSolver& solver, const Eigen::MatrixXd& locked,
                  const ProgressCallback& progress, std::uint64_t& solves)
      : solver_(solver), locked_(locked), progress_(progress), solves_(solves) {}

  Eigen::Index rows() const { return locked_.rows(); }
  Eigen::Index cols() const { return locked_.rows(); }

  void perform_op(const double* in, double* out) const {
    const Eigen::Map<const Eigen::VectorXd> x(in, rows());
    const Eigen::VectorXd rest = project(x);
    Eigen::Map<Eigen::VectorXd>(out, rows()) = scale_ * multiply(rest) - (x - rest);
  }

  /// Makes the largest eigenvalue about 1: Spectra compares some numbers with constants.
  /// @returns false if nothing is left of the operator
  bool normalise(Eigen::VectorXd start) {
    start = project(start);
    for (int step = 0; step < 3; ++step) {
      const Eigen::VectorXd next = multiply(start.normalized());
      if (!(next.norm() > 0.0)) return false;
      scale_ = 1.0 / next.norm();
      start = next;
    }
    return true;
  }

 private:
  Eigen::VectorXd multiply(const Eigen::VectorXd& x) const {
    ++solves_;
    if (progress_ && !progress_({"eigenpairs", solves_, 0})) throw Cancelled();
    return project(solver_.solve(x));
  }

  /// Onto the complement of null and locked vectors.
  Eigen::VectorXd project(Eigen::VectorXd x) const {
    solver_.remove_null_space(x);
    x -= locked_ * (locked_.transpose() * x).eval();
    return x;
  }

  LaplacianSolver& solver_;
  const Eigen::MatrixXd& locked_;
  const ProgressCallback& progress_;
  std::uint64_t& solves_;
  double scale_ = 1.0;
};

Eigen::VectorXd random_vector(Index size, Random& random) {
  Eigen::VectorXd vector(size);
  for (double& entry : vector) entry = random.uniform(-1.0, 1.0);
  return vector;
}

}  // namespace

PseudoInversePairs::PseudoInversePairs(const Laplacian& laplacian, const EigenOptions& options)
    : solver_(laplacian),
      size_(laplacian.size()),
      null_count_(laplacian.components().count),
      options_(options) {}

Eigen::MatrixXd PseudoInversePairs::vectors(Index count, const Eigen::MatrixXd& locked) {
  const Index complement = size_ - null_count_ - static_cast<Index>(locked.cols());
  count = std::min(count, complement);
  DeflatedInverse inverse(solver_, locked, options_.progress, solves_);
  Random random(kSeed);
  if (count <= 0 || !inverse.normalise(random_vector(size_, random))) {
    return Eigen::MatrixXd(size_, 0);
  }
  const Index room = std::min(complement, std::max(2 * count + 2, kSmallestBasis));
  for (int start = 0;; ++start) {
    try {
      Spectra::SymEigsSolver<DeflatedInverse> solver(inverse, count, std::max(room, count + 1));
      solver.init(random_vector(size_, random).data());
      solver.compute(Spectra::SortRule::LargestAlge, options_.max_restarts, kRitzTolerance);
      return solver.eigenvectors();
    } catch (const Error&) {
      throw;
    } catch (const std::runtime_error& error) {  // Spectra's
      if (start == kMostStarts) throw NumericalError("eigenpairs", error.what());
    }
  }
}

}  // namespace isotherm::spectral::detail
