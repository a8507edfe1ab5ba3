#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral {

namespace detail {
class CholmodFactor;
struct Supernodes;
}  // namespace detail

/// How a Cholesky factor is stored.
enum class FactorForm {
  fastest,     ///< whatever takes the least time to factorise and to solve
  supernodal,  ///< by dense blocks of columns, as covariances are read from
};

/// A symmetric matrix of dense square blocks, one block row a pose, and its
/// Cholesky factor.
///
/// The pattern is given once; values change between factorisations, which then
/// cost only the numerical part. The fill-reducing order is computed on the
/// graph of blocks (chains first, then the sparser of AMD and nested dissection),
/// which is block_size^2 times smaller than the scalar matrix.
class BlockCholesky {
 public:
  /// @param pairs off-diagonal blocks that may be non-zero, as (row, column) in
  ///   either order, row != column; repeats are allowed and share their storage.
  BlockCholesky(int block_size, Index block_count, std::span<const std::pair<Index, Index>> pairs,
                FactorForm form = FactorForm::fastest);
  ~BlockCholesky();
  BlockCholesky(BlockCholesky&&) noexcept;
  BlockCholesky& operator=(BlockCholesky&&) noexcept;

  int block_size() const noexcept { return block_size_; }
  Index block_count() const noexcept { return static_cast<Index>(diagonals_.size()); }
  Eigen::Index size() const noexcept { return Eigen::Index{block_count()} * block_size_; }

  /// Sets every value to zero.
  void clear();

  /// Adds to the diagonal block of `block`; `value` must be symmetric.
  template <class Derived>
  void add_diagonal(Index block, const Eigen::MatrixBase<Derived>& value) {
    view<Derived>(diagonals_[static_cast<std::size_t>(block)]) += value;
  }

  /// Adds to the block in the row and column of pairs[pair].
  template <class Derived>
  void add_pair(std::size_t pair, const Eigen::MatrixBase<Derived>& value) {
    const PairPlace& place = pairs_[pair];
    if (place.transposed) {
      view<Derived>(place.block) += value.transpose();
    } else {
      view<Derived>(place.block) += value;
    }
  }

  /// The matrix's own diagonal, without any damping.
  Eigen::VectorXd diagonal() const;

  /// Product of the matrix (without damping) with a vector.
  Eigen::VectorXd multiply(const Eigen::VectorXd& x) const;

  /// Factorises the matrix plus diag(damping); an empty vector stands for zero.
  /// Returns false where the sum is not numerically positive definite.
  bool factorise(const Eigen::VectorXd& damping = {});

  /// Solves with the last factor; `rhs` may have several columns.
  /// @throws NumericalError without a successful factorise() before.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& rhs) const;

  /// log |A + diag(damping)|, natural, of the matrix that was factorised last.
  /// @throws NumericalError without a successful factorise() before.
  double log_determinant() const;

  /// Floating-point operations of one factorisation. Follows from the pattern alone.
  double flops() const;

  /// A = L L' by dense blocks of columns, which part no block of rows.
  /// Valid until the next factorisation. Without a successful factorise() before there
  /// are no values.
  /// @throws InvalidArgument unless the form is supernodal
  detail::Supernodes supernodes() const;

 private:
  // A block inside the column-compressed values: the place of its first entry
  // and the distance between its columns.
  struct BlockPlace {
    std::ptrdiff_t first = 0;
    std::ptrdiff_t stride = 0;
  };
  struct PairPlace {
    BlockPlace block;
    bool transposed = false;
  };

  template <class Derived>
  auto view(const BlockPlace& place) {
    constexpr int kRows = Derived::RowsAtCompileTime;
    constexpr int kColumns = Derived::ColsAtCompileTime;
    using Block = Eigen::Matrix<double, kRows, kColumns, Eigen::ColMajor>;
    return Eigen::Map<Block, 0, Eigen::OuterStride<>>(
        values_.data() + place.first, block_size_, block_size_, Eigen::OuterStride<>(place.stride));
  }

  void set_diagonal(const Eigen::VectorXd& diagonal);
  void lay_out(std::span<const std::pair<Index, Index>> pairs);

  int block_size_;
  FactorForm form_;
  std::vector<BlockPlace> diagonals_;
  std::vector<PairPlace> pairs_;
  // Lower triangle by columns; diagonal blocks are stored in full.
  std::vector<int> column_starts_;
  std::vector<int> rows_;
  std::vector<double> values_;
  std::unique_ptr<detail::CholmodFactor> factor_;  // none without blocks
};

}  // namespace isotherm::spectral
