#include "isotherm/spectral/eigen/eigen_decomposition.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Eigenvalues>

#include "eigen/pseudo_inverse_lanczos.hpp"
#include "isotherm/base/error.hpp"
#include "sparse/cholmod_factor.hpp"

namespace isotherm::spectral {
namespace {

constexpr int kMaxRounds = 4;  // searches for eigenpairs that the iteration missed

struct Pairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// All pairs that are not null. The null space is moved above the spectrum, so
/// that it cannot mix with small eigenvalues.
Pairs dense_pairs(const Laplacian& laplacian, Index count) {
  const SparseMatrix basis = laplacian.null_space();
  Eigen::MatrixXd matrix(laplacian.matrix());
  const double shift = laplacian.norm_bound() > 0.0 ? 2.0 * laplacian.norm_bound() : 1.0;
  matrix += shift * Eigen::MatrixXd(SparseMatrix(basis * basis.transpose()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) {
    throw NumericalError("eigenpairs", "the dense solver did not converge");
  }
  return {solver.eigenvalues().head(count), solver.eigenvectors().leftCols(count)};
}

/// The `count` smallest of both, in ascending order.
Pairs merge(const Pairs& first, const Pairs& second, Index count) {
  const Index total = static_cast<Index>(first.values.size() + second.values.size());
  Eigen::VectorXd values(total);
  Eigen::MatrixXd vectors(first.vectors.rows(), total);
  values << first.values, second.values;
  vectors << first.vectors, second.vectors;
  std::vector<Index> order(total);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return values[a] < values[b]; });
  order.resize(std::min(total, count));
  return {values(order), vectors(Eigen::all, order)};
}

/// Replaces eigenvalues by Rayleigh quotients, which are accurate to the square
/// of the vectors' error.
void refine(const Laplacian& laplacian, Pairs& pairs) {
  for (Index k = 0; k < pairs.values.size(); ++k) {
    const auto vector = pairs.vectors.col(k);
    pairs.values[k] = std::max(0.0, vector.dot(laplacian.matrix() * vector));
  }
}

/// How many eigenvalues lie below `bound`.
std::int64_t count_below(const Laplacian& laplacian, double bound) {
  SparseMatrix shifted = laplacian.matrix();
  for (Index v = 0; v < laplacian.size(); ++v) shifted.coeffRef(v, v) -= bound;
  return detail::CholmodFactor(shifted, detail::FactorKind::symmetric).negative_pivots();
}

/// A point just below the largest eigenvalue found, clear of its rounding, so
/// that a cluster cut by `count` is not taken for missing pairs.
double inertia_bound(const Laplacian& laplacian, const Pairs& pairs) {
  constexpr double kUnit = std::numeric_limits<double>::epsilon();
  const auto last = pairs.vectors.rightCols<1>();
  const double value = pairs.values[pairs.values.size() - 1];
  const double residual = (laplacian.matrix() * last - value * last).norm();
  return value - std::max({2.0 * residual, 1e-7 * value, 32.0 * kUnit * laplacian.norm_bound()});
}

std::int64_t found_below(const Pairs& pairs, double bound) {
  return std::count_if(pairs.values.begin(), pairs.values.end(),
                       [bound](double value) { return value < bound; });
}

struct Search {
  Pairs pairs;
  std::int64_t inertia_count = -1;
  bool complete = true;
};

/// Iterates for the pairs that are not null, then counts, and looks again in
/// the complement of what was found while the count says that some are missing.
Search iterate(const Laplacian& laplacian, Index count, Index nulls, const EigenOptions& options) {
  detail::PseudoInverseLanczos lanczos(laplacian, options);
  Search search;
  auto first = lanczos.largest(count, Eigen::MatrixXd(laplacian.size(), 0));
  search.pairs = {std::move(first.values), std::move(first.vectors)};
  refine(laplacian, search.pairs);
  search.pairs =
      merge(search.pairs, {Eigen::VectorXd(0), Eigen::MatrixXd(laplacian.size(), 0)}, count);
  for (int round = 0; options.check_inertia && search.pairs.values.size() > 0; ++round) {
    const double bound = inertia_bound(laplacian, search.pairs);
    if (bound <= 0.0) break;
    const std::int64_t counted = count_below(laplacian, bound);
    const std::int64_t missing = counted - nulls - found_below(search.pairs, bound);
    search.inertia_count = counted;
    search.complete = missing <= 0;
    if (search.complete || round == kMaxRounds) break;
    auto more = lanczos.largest(static_cast<Index>(missing), search.pairs.vectors);
    Pairs missed{std::move(more.values), std::move(more.vectors)};
    refine(laplacian, missed);
    search.pairs = merge(search.pairs, missed, count);
  }
  return search;
}

/// Makes the entry of largest magnitude positive; of entries equal to within
/// rounding, the first.
void fix_sign(Eigen::Ref<Eigen::VectorXd> vector) {
  const double largest = vector.cwiseAbs().maxCoeff();
  for (Index v = 0; v < vector.size(); ++v) {
    if (std::abs(vector[v]) < (1.0 - 1e-6) * largest) continue;
    if (vector[v] < 0.0) vector = -vector;
    return;
  }
}

void assess(const Laplacian& laplacian, double tolerance, EigenDecomposition& result) {
  result.residuals =
      (laplacian.matrix() * result.vectors - result.vectors * result.values.asDiagonal())
          .colwise()
          .norm();
  const Index count = result.count();
  if (count == 0) return;
  const Eigen::MatrixXd gram = result.vectors.transpose() * result.vectors;
  result.orthogonality = (gram - Eigen::MatrixXd::Identity(count, count)).cwiseAbs().maxCoeff();
  if (result.residuals.maxCoeff() > tolerance * result.norm) {
    result.status = EigenStatus::not_converged;
  }
}

EigenMethod choose(const EigenOptions& options, Index size, Index count) {
  if (count > size / 3) return EigenMethod::dense;
  if (options.method != EigenMethod::automatic) return options.method;
  return size <= options.dense_limit ? EigenMethod::dense : EigenMethod::shift_invert;
}

}  // namespace

void EigenOptions::validate() const {
  if (count < 1) throw InvalidArgument("count", "must be at least 1");
  if (dense_limit < 0) throw InvalidArgument("dense_limit", "must not be negative");
  if (!(tolerance > 0.0)) throw InvalidArgument("tolerance", "must be positive");
  if (max_restarts < 1) throw InvalidArgument("max_restarts", "must be at least 1");
}

EigenDecomposition smallest_eigenpairs(const Laplacian& laplacian, const EigenOptions& options) {
  options.validate();
  const auto start = std::chrono::steady_clock::now();
  const Index size = laplacian.size();
  const Index count = std::min(options.count, size);
  const Index nulls = std::min(count, laplacian.components().count);

  EigenDecomposition result;
  result.kind = laplacian.kind();
  result.norm = laplacian.norm_bound();
  result.null_count = nulls;
  result.method = choose(options, size, count);
  result.values = Eigen::VectorXd::Zero(count);
  result.vectors.resize(size, count);
  result.vectors.leftCols(nulls) = laplacian.null_space().leftCols(nulls);
  if (count > nulls) {
    Search search;
    if (result.method == EigenMethod::dense) {
      search.pairs = dense_pairs(laplacian, count - nulls);
    } else {
      search = iterate(laplacian, count - nulls, nulls, options);
    }
    result.values.tail(count - nulls) = search.pairs.values;
    result.vectors.rightCols(count - nulls) = search.pairs.vectors;
    result.inertia_count = search.inertia_count;
    if (!search.complete) result.status = EigenStatus::missed_pairs;
  }
  for (Index k = 0; k < count; ++k) fix_sign(result.vectors.col(k));
  assess(laplacian, options.tolerance, result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace isotherm::spectral
