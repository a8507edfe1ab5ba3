#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/sparse/block_cholesky.hpp"
#include "sparse/cholmod_factor.hpp"

namespace isotherm::spectral::detail {

/// The supernodes of a factor A = L L' as a tree of dense fronts, counted in blocks of
/// rows (of one, for a scalar matrix).
///
/// A front's rows are its own columns, in order of elimination, and then the rows of L
/// below them. All of the latter are rows of the parent's front. Children come before
/// their parents, and a front's last descendant right before it.
class FrontTree {
 public:
  static constexpr Index kNone = -1;
  using Values = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  FrontTree() = default;

  /// `supernodes` must not part a block. What holds their values must outlive this
  /// object's use of values().
  FrontTree(const Supernodes& supernodes, int block_size);

  /// `factor` must outlive this object, and not be factorised meanwhile.
  /// @throws InvalidArgument if the factor is not supernodal
  explicit FrontTree(const BlockCholesky& factor);

  int block_size() const noexcept { return block_size_; }
  Index front_count() const noexcept { return static_cast<Index>(parent_.size()); }
  Index parent(Index front) const { return parent_[front]; }

  Index width(Index front) const { return first_column_[front + 1] - first_column_[front]; }
  Index size(Index front) const { return row_start_[front + 1] - row_start_[front]; }

  /// When a front's rows are eliminated, ascending.
  std::span<const Index> rows(Index front) const {
    return std::span(rows_).subspan(row_start_[front], size(front));
  }
  Index row(Index front, Index k) const { return rows_[row_start_[front] + k]; }
  /// Which of the front's rows a block is; kNone if none.
  Index place(Index front, Index block) const;

  /// Rows in the parent's front of the rows below this front's own columns.
  std::span<const Index> place_in_parent(Index front) const {
    return std::span(place_in_parent_)
        .subspan(row_start_[front] + width(front), size(front) - width(front));
  }

  Index block_count() const noexcept { return static_cast<Index>(position_.size()); }
  /// When a block is eliminated.
  Index position(Index block) const { return position_[block]; }
  /// The front that eliminates what is at a position.
  Index front_at(Index position) const { return front_at_[position]; }

  /// Which block of A a front's own column is.
  Index block(Index front, Index column) const { return block_at_[first_column_[front] + column]; }
  /// The front that eliminates a block, and its column there.
  Index front_of(Index block) const { return front_at_[position_[block]]; }
  Index column_of(Index block) const { return position_[block] - first_column_[front_of(block)]; }

  /// The front's part of L: size x width blocks, lower triangular on top.
  Values values(Index front) const;

  /// Where the branches of two fronts meet; kNone on different trees.
  Index meeting(Index a, Index b) const;

 private:
  void link_fronts();

  int block_size_ = 1;
  std::span<const Index> value_start_;
  std::span<const double> values_;
  std::vector<Index> first_column_;
  std::vector<Index> row_start_;
  std::vector<Index> rows_;
  std::vector<Index> parent_;
  std::vector<Index> place_in_parent_;
  std::vector<Index> position_;  // of a block in the order of elimination
  std::vector<Index> block_at_;  // its inverse
  std::vector<Index> front_at_;  // front of a position
};

}  // namespace isotherm::spectral::detail
