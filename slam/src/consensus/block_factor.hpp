#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/types.hpp"

namespace isotherm::slam::detail {

using spectral::Index;

/// Sparse Cholesky factorisation A = L L' of a positive definite matrix of
/// Dof x Dof blocks, with open access to what covariances need: the quadratic
/// form B' A^-1 B for a B that is zero outside two block rows.
///
/// Such a form is |L^-1 B|^2, and L^-1 B is zero outside the paths from the two
/// blocks to the root of the elimination tree (T. Davis, "Direct Methods for
/// Sparse Linear Systems", 2006, section 3.2), so that it costs a small part of
/// a solve. Thread-safe once factorised.
template <int Dof>
class BlockFactor {
 public:
  using Block = Eigen::Matrix<double, Dof, Dof>;

  /// Orders the blocks (approximate minimum degree) and lays out L.
  /// `pairs` are the off-diagonal blocks of A, either order, repeats allowed;
  /// both ends differ and lie in [0, count).
  BlockFactor(Index count, std::span<const std::pair<Index, Index>> pairs);

  Index count() const noexcept { return static_cast<Index>(order_.size()); }

  /// Blocks of L below the diagonal.
  std::size_t fill() const noexcept { return rows_.size(); }

  void clear();
  void add_diagonal(Index block, const Block& value) { diagonal_[position_[block]] += value; }

  /// Adds to A(a, b) = A(b, a)' for pairs[pair] = (a, b).
  void add_pair(std::size_t pair, const Block& value) {
    const auto& place = places_[pair];
    if (place.transposed) {
      off_diagonal_[place.at] += value.transpose();
    } else {
      off_diagonal_[place.at] += value;
    }
  }

  /// Replaces A by its factor; false if it is not numerically positive definite.
  bool factorise();

  /// x = A^-1 b, in place; segments of Dof entries a block.
  void solve(Eigen::VectorXd& x) const;

  /// Scratch memory of quadratic_form(), one a thread.
  using Workspace = std::vector<Block>;
  Workspace make_workspace() const { return Workspace(order_.size(), Block::Zero()); }

  /// B' A^-1 B where B has the blocks Ba, Bb in the block rows a, b and is zero
  /// elsewhere. A negative row stands for a block that A does not have.
  Block quadratic_form(Workspace& workspace, Index a, const Block& Ba, Index b,
                       const Block& Bb) const;

 private:
  struct Place {
    std::size_t at = 0;
    bool transposed = false;
  };

  void order_blocks(std::span<const std::pair<Index, Index>> pairs);
  void lay_out(std::span<const std::pair<Index, Index>> pairs);
  bool factorise_column(Index column);
  Index parent(Index column) const {
    return starts_[column] < starts_[column + 1] ? rows_[starts_[column]] : count();
  }

  std::vector<Index> order_;     // the block eliminated k-th
  std::vector<Index> position_;  // its inverse
  // L by columns: the inverses of the diagonal blocks, and the blocks below.
  std::vector<std::size_t> starts_;
  std::vector<Index> rows_;
  std::vector<Block> diagonal_;
  std::vector<Block> off_diagonal_;
  std::vector<Place> places_;
};

extern template class BlockFactor<3>;
extern template class BlockFactor<6>;

}  // namespace isotherm::slam::detail
