#include "sparse/inverse/half_solve.hpp"

#include <algorithm>
#include <functional>

#include "sparse/dense_kernels.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr Eigen::Index kFewestRows = 16;  // below these, dense kernels do not pay

}  // namespace

template <int Dof>
HalfSolve<Dof>::HalfSolve(const FrontTree& tree, Index front, std::span<const Index> blocks,
                          Eigen::Index most_entries)
    : tree_(tree), front_(front), place_(tree.block_count(), FrontTree::kNone) {
  std::vector<bool> wanted(tree.front_count(), false);
  wanted[front] = true;
  fronts_.push_back(front);
  for (const Index block : blocks) {
    for (Index f = tree.front_of(block); !wanted[f]; f = tree.parent(f)) {
      wanted[f] = true;
      fronts_.push_back(f);
    }
  }
  std::ranges::sort(fronts_, std::greater());
  Index count = 0;
  for (const Index f : fronts_) {
    for (Index k = 0; k < tree.width(f); ++k) place_[tree.row(f, k)] = count++;
  }
  const Eigen::Index columns = Eigen::Index{count} * Dof;
  slab_ = std::max(kFewestRows, most_entries / columns);
  x_.resize(0, columns);
}

template <int Dof>
bool HalfSolve<Dof>::next() {
  const Eigen::Index rows = std::min(slab_, Eigen::Index{tree_.width(front_)} * Dof - solved_);
  if (rows == 0) return false;
  x_.setZero(rows, x_.cols());
  x_.middleCols(solved_, rows).setIdentity();  // the front's own columns come first
  for (const Index f : fronts_) solve(f);
  solved_ += rows;
  return true;
}

template <int Dof>
void HalfSolve<Dof>::solve(Index front) {
  const auto L = tree_.values(front);
  const Index width = tree_.width(front);
  // Rows above the front that the object is of have no part in its rows of L^-1.
  Index inside = width;
  above_.resize(x_.rows(), L.rows() - L.cols());
  for (; inside < tree_.size(front); ++inside) {
    const Index place = place_[tree_.row(front, inside)];
    if (place == FrontTree::kNone) break;
    above_.template middleCols<Dof>((inside - width) * Dof) =
        x_.template middleCols<Dof>(place * Dof);
  }
  const Eigen::Index used = Eigen::Index{inside - width} * Dof;
  auto own = x_.middleCols(place_[tree_.row(front, 0)] * Dof, L.cols());
  add_product(own, -1.0, above_.leftCols(used), L.middleRows(L.cols(), used));
  solve_lower_from_right(L.topRows(L.cols()), own);
}

template class HalfSolve<2>;
template class HalfSolve<3>;
template class HalfSolve<6>;

}  // namespace isotherm::spectral::detail
