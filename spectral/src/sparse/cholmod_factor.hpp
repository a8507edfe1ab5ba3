#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

/// The lower triangle of a symmetric matrix by columns, rows ascending. What stands
/// above the diagonal is ignored.
struct LowerTriangle {
  std::span<const Index> starts;  ///< one a column, and the end
  std::span<const Index> rows;
  const double* values = nullptr;  ///< like `rows`; none for a bare pattern
};

LowerTriangle lower_triangle(const SparseMatrix& matrix);

/// A factor L by supernodes: runs of columns with the same rows below them. All indices
/// count rows of the matrix, in order of elimination.
struct Supernodes {
  std::span<const Index> first_column;  ///< one a supernode, and the end
  std::span<const Index> row_start;     ///< in `rows`, one a supernode, and the end
  std::span<const Index> rows;          ///< ascending; own columns first
  std::span<const Index> value_start;   ///< in `values`, one a supernode
  std::span<const double> values;       ///< dense and by columns; lower triangular on top
  std::span<const Index> order;         ///< the row of the matrix eliminated k-th
};

enum class FactorKind {
  positive_definite,  ///< LL' in whatever form CHOLMOD takes least time for
  known_definite,     ///< the same, but LDL' by columns, which no rounded pivot breaks down
  supernodal,         ///< LL' by dense blocks of columns, which are found beforehand
  symmetric,          ///< LDL' without pivoting; may be indefinite
};

/// The project's only door to CHOLMOD. Without the GPL, the factor is always the
/// simplicial one, from which the supernodal form is copied. Not safe for use by several
/// threads at once: CHOLMOD keeps its workspace in one place.
class CholmodFactor {
 public:
  /// Analyses a pattern, in an order of elimination or, where it is empty, in one that
  /// CHOLMOD finds. A factor keeps to the tree's postorder.
  /// @throws NumericalError if memory runs out
  CholmodFactor(const LowerTriangle& pattern, FactorKind kind, std::span<const Index> order = {});

  /// Analyses and factorises. @throws NumericalError if a pivot breaks down
  CholmodFactor(const SparseMatrix& matrix, FactorKind kind);
  ~CholmodFactor();
  CholmodFactor(CholmodFactor&&) noexcept;

  /// Factorises a matrix of the pattern that was analysed; false if a pivot breaks down,
  /// as in a matrix that is not positive definite where the kind asks for that.
  /// @throws NumericalError if memory runs out
  bool factorise(const LowerTriangle& matrix);

  /// x = A^-1 b, for n entries each; they may be the same memory.
  /// @throws NumericalError without a factor, as the next three do
  void solve(const double* b, double* x);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& rhs) const;

  /// log |A|, natural. Only of a definite matrix.
  double log_determinant() const;

  /// Number of negative pivots, which by Sylvester's law is the number of
  /// negative eigenvalues. Only for FactorKind::symmetric.
  Index negative_pivots() const;

  /// Valid until the next factorisation; no values before the first. Only for
  /// FactorKind::supernodal.
  Supernodes supernodes() const;

  double flops() const;    ///< of one factorisation
  double entries() const;  ///< of L

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The sparser of the orders that AMD and nested dissection find, in postorder.
/// @throws NumericalError if memory runs out
std::vector<Index> fill_reducing_order(const LowerTriangle& pattern);

}  // namespace isotherm::spectral::detail
