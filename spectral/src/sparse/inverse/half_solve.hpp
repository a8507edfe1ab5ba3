#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "sparse/inverse/front_tree.hpp"

namespace isotherm::spectral::detail {

/// Those rows of L^-1 that belong to one front's own columns, for blocks that are
/// eliminated there or below. Since Z = A^-1 = (L^-1)' L^-1, the products of two blocks'
/// columns, summed over all fronts from where their branches meet to the root, are Z_ab.
///
/// With J the columns of a front and R the rows below them, X = E_m L^-1 for the rows m
/// solves X_J L_JJ = E_J - X_R L_RJ, from the front down. All branches that lead to a
/// block share their way: as many multiplications a row as L has entries there.
template <int Dof>
class HalfSolve {
 public:
  /// @param tree must outlive this object
  /// @param most_entries that are held at once, so that rows come in slabs
  HalfSolve(const FrontTree& tree, Index front, std::span<const Index> blocks,
            Eigen::Index most_entries = Eigen::Index{1} << 22);

  /// Solves for the next rows; false once there are none left.
  bool next();

  /// The present rows of a block's columns: rows x Dof.
  auto of(Index block) const {
    return x_.template middleCols<Dof>(place_[tree_.position(block)] * Dof);
  }

 private:
  void solve(Index front);

  const FrontTree& tree_;
  Index front_;
  std::vector<Index> fronts_;  // on the way to a block, parents first
  std::vector<Index> place_;   // among the columns of x, one a position of elimination
  Eigen::Index slab_;          // rows at once
  Eigen::Index solved_ = 0;
  Eigen::MatrixXd x_;
  Eigen::MatrixXd above_;  // X_R
};

extern template class HalfSolve<2>;
extern template class HalfSolve<3>;
extern template class HalfSolve<6>;

}  // namespace isotherm::spectral::detail
