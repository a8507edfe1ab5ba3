#include "isotherm/spectral/eigen/eigen_decomposition.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Eigenvalues>

#include "eigen/pseudo_inverse_pairs.hpp"
#include "isotherm/base/error.hpp"
#include "sparse/cholmod_factor.hpp"

namespace isotherm::spectral {
namespace {

constexpr int kMaxRounds = 4;  // searches for eigenpairs that the iteration missed
constexpr int kLook = 8;       // pairs of one that does not know how many are missing

struct Pairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Vectors of all pairs that are not null, in ascending order. The null space is moved
/// above the spectrum, so that it cannot mix with small eigenvalues.
Eigen::MatrixXd dense_vectors(const Laplacian& laplacian, Index count) {
  const SparseMatrix basis = laplacian.null_space();
  Eigen::MatrixXd matrix(laplacian.matrix());
  const double shift = laplacian.norm_bound() > 0.0 ? 2.0 * laplacian.norm_bound() : 1.0;
  matrix += shift * Eigen::MatrixXd(SparseMatrix(basis * basis.transpose()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) {
    throw NumericalError("eigenpairs", "the dense solver did not converge");
  }
  return solver.eigenvectors().leftCols(count);
}

/// The Rayleigh quotients of unit vectors, which are accurate to the square of the vectors'
/// error, as sums over edges: no term is negative, so that small ones do not drown in
/// large degrees.
Eigen::VectorXd energies(const Laplacian& laplacian, const Eigen::MatrixXd& vectors) {
  const auto& matrix = laplacian.matrix();
  Eigen::VectorXd null = Eigen::VectorXd::Ones(laplacian.size());
  if (laplacian.kind() == LaplacianKind::normalised) null = laplacian.degrees().cwiseSqrt();
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(vectors.cols());
  for (Eigen::Index k = 0; k < sums.size(); ++k) {
    const auto x = vectors.col(k);
    for (Eigen::Index column = 0; column < matrix.outerSize(); ++column) {
      for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry) {
        const Eigen::Index row = entry.row();
        if (row >= column) break;
        const double step = x[row] / null[row] - x[column] / null[column];
        sums[k] -= entry.value() * null[row] * null[column] * step * step;
      }
    }
  }
  return sums;
}

/// With more vectors, the `count` pairs of smallest values of all, in ascending order.
Pairs merge(const Laplacian& laplacian, const Pairs& pairs, const Eigen::MatrixXd& more,
            Index count) {
  Eigen::VectorXd values(pairs.values.size() + more.cols());
  Eigen::MatrixXd vectors(more.rows(), values.size());
  values << pairs.values, energies(laplacian, more);
  vectors << pairs.vectors, more;
  std::vector<Eigen::Index> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return values[a] < values[b]; });
  order.resize(std::min<std::size_t>(order.size(), count));
  return {values(order), vectors(Eigen::all, order)};
}

/// How many eigenvalues lie below `bound`.
std::int64_t count_below(const Laplacian& laplacian, double bound) {
  SparseMatrix shifted = laplacian.matrix();
  for (Index v = 0; v < laplacian.size(); ++v) shifted.coeffRef(v, v) -= bound;
  return detail::CholmodFactor(shifted, detail::FactorKind::symmetric).negative_pivots();
}

/// How far eigenvalues may be off through rounding of the matrix itself.
double rounding(const Laplacian& laplacian) {
  return 32.0 * std::numeric_limits<double>::epsilon() * laplacian.norm_bound();
}

/// A point just below the largest eigenvalue found, clear of its rounding, so
/// that a cluster cut by `count` is not taken for missing pairs.
double inertia_bound(const Laplacian& laplacian, const Pairs& pairs) {
  const auto last = pairs.vectors.rightCols<1>();
  const double value = pairs.values[pairs.values.size() - 1];
  const double residual = (laplacian.matrix() * last - value * last).norm();
  return value - std::max({2.0 * residual, 1e-7 * value, rounding(laplacian)});
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

/// Iterates for the pairs that are not null, then counts, and looks again in the
/// complement of what was found while the count says that some are missing; without a count,
/// while smaller ones turn up there.
Search iterate(const Laplacian& laplacian, Index count, const EigenOptions& options) {
  detail::PseudoInversePairs inverse(laplacian, options);
  Search search;
  search.pairs.vectors.resize(laplacian.size(), 0);
  std::int64_t missing = count;
  double last = std::numeric_limits<double>::infinity();
  const Index complement = laplacian.size() - laplacian.components().count;
  for (int round = 0; missing > 0 && round <= kMaxRounds; ++round) {
    const Index wanted = static_cast<Index>(std::min<std::int64_t>(missing, count));
    search.pairs =
        merge(laplacian, search.pairs, inverse.vectors(wanted, search.pairs.vectors), count);
    missing = count - search.pairs.values.size();
    if (search.pairs.values.size() == 0) continue;
    if (!options.check_inertia) {
      const double largest = search.pairs.values.maxCoeff();
      const auto left = complement - search.pairs.values.size();  // a small rest needs no look
      const bool look = largest < (1.0 - 1e-7) * last && left > 3 * kLook;
      if (look) missing = std::max<std::int64_t>(missing, kLook);
      last = largest;
      continue;
    }
    const double bound = inertia_bound(laplacian, search.pairs);
    if (bound <= 0.0) continue;
    search.inertia_count = count_below(laplacian, bound);
    const std::int64_t missed =
        search.inertia_count - laplacian.components().count - found_below(search.pairs, bound);
    search.complete = missed <= 0;
    missing = std::max(missing, missed);
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

/// The null vectors, and what was found beside them.
void join(const Laplacian& laplacian, const Pairs& pairs, EigenDecomposition& result) {
  const Index nulls = result.null_count;
  const auto found = static_cast<Index>(pairs.values.size());
  result.values = Eigen::VectorXd::Zero(nulls + found);
  result.values.tail(found) = pairs.values;
  result.vectors.resize(laplacian.size(), nulls + found);
  result.vectors.leftCols(nulls) = laplacian.null_space().leftCols(nulls);
  result.vectors.rightCols(found) = pairs.vectors;
}

void assess(const Laplacian& laplacian, double tolerance, EigenDecomposition& result) {
  result.residuals =
      (laplacian.matrix() * result.vectors - result.vectors * result.values.asDiagonal())
          .colwise()
          .norm();
  result.bounds = result.residuals.array() + rounding(laplacian);
  result.bounds.head(result.null_count).setZero();
  const Index count = result.count();
  if (count == 0) return;
  const Eigen::MatrixXd gram = result.vectors.transpose() * result.vectors;
  result.orthogonality = (gram - Eigen::MatrixXd::Identity(count, count)).cwiseAbs().maxCoeff();
  const bool close = result.residuals.maxCoeff() <= tolerance * result.norm;
  const Index rest = count - result.null_count;
  const bool positive = (result.values.tail(rest).array() > result.bounds.tail(rest).array()).all();
  if (!close || !positive) result.status = EigenStatus::not_converged;
}

EigenMethod choose(const EigenOptions& options, const Laplacian& laplacian, Index wanted) {
  const Index complement = laplacian.size() - laplacian.components().count;
  if (wanted > complement / 3) return EigenMethod::dense;
  if (options.method != EigenMethod::automatic) return options.method;
  return laplacian.size() <= options.dense_limit ? EigenMethod::dense : EigenMethod::shift_invert;
}

}  // namespace

void EigenOptions::validate() const { require_fields_in_range(*this); }

EigenDecomposition smallest_eigenpairs(const Laplacian& laplacian, const EigenOptions& options) {
  options.validate();
  const auto start = std::chrono::steady_clock::now();
  const Index components = laplacian.components().count;
  const Index nulls = options.null_vectors ? std::min(options.count, components) : 0;
  const Index wanted = std::min(options.count - nulls, laplacian.size() - components);

  EigenDecomposition result;
  result.kind = laplacian.kind();
  result.norm = laplacian.norm_bound();
  result.null_count = nulls;
  result.method = choose(options, laplacian, wanted);
  Search search;
  search.pairs.vectors.resize(laplacian.size(), 0);
  if (wanted > 0 && result.method == EigenMethod::dense) {
    search.pairs = merge(laplacian, search.pairs, dense_vectors(laplacian, wanted), wanted);
  } else if (wanted > 0) {
    search = iterate(laplacian, wanted, options);
  }
  join(laplacian, search.pairs, result);
  result.inertia_count = search.inertia_count;
  if (result.count() < nulls + wanted) result.status = EigenStatus::not_converged;
  if (!search.complete) result.status = EigenStatus::missed_pairs;
  for (Index k = 0; k < result.count(); ++k) fix_sign(result.vectors.col(k));
  assess(laplacian, options.tolerance, result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace isotherm::spectral
