#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "sparse/inverse/front_tree.hpp"

namespace isotherm::spectral::detail {

/// Those rows of L^-1 that belong to one front's own columns, for pairs of blocks that are
/// eliminated there or below. Since Z = A^-1 = (L^-1)' L^-1, the products of two blocks'
/// columns, summed over all fronts from where their branches meet to the root, are Z_ab.
///
/// With J the columns of a front and R the rows below them, X = E_m L^-1 for the rows m
/// solves X_J L_JJ = E_J - X_R L_RJ, from the front down. All branches that lead to a
/// block share their way: as many multiplications a row as L has entries there. Rows come
/// in slabs, each on its own.
template <int Dof>
class HalfSolve {
 public:
  using Pair = std::pair<Index, Index>;
  using Block = Eigen::Matrix<double, Dof, Dof>;

  /// @param tree must outlive this object, and so must `pairs`
  /// @param most_entries of a slab
  HalfSolve(const FrontTree& tree, Index front, std::span<const Pair> pairs,
            Eigen::Index most_entries = Eigen::Index{1} << 24);

  /// X_a' X_b of every pair, over all rows; the same bits on any number of threads (0: all
  /// cores).
  std::vector<Block> products(int threads) const;

 private:
  // Rows of X, and room to solve for them.
  struct Slab {
    Eigen::Index first = 0;  // of the front's own
    Eigen::MatrixXd x;
    Eigen::MatrixXd above;  // X_R
  };
  void solve(Index number, Slab& slab) const;
  void solve_front(Index front, Slab& slab) const;
  auto columns_of(Index block, const Slab& slab) const {
    return slab.x.template middleCols<Dof>(place_[tree_.position(block)] * Dof);
  }

  const FrontTree& tree_;
  Index front_;
  std::span<const Pair> pairs_;
  std::vector<Index> fronts_;  // on the way to a block, parents first
  std::vector<Index> place_;   // among the columns of X, one a position of elimination
  Eigen::Index columns_;       // of X
  Eigen::Index slab_rows_;
  Index slab_count_;
};

extern template class HalfSolve<2>;
extern template class HalfSolve<3>;
extern template class HalfSolve<6>;

}  // namespace isotherm::spectral::detail
