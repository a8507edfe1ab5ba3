#include "sparse/inverse/half_solve.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>

#include "isotherm/base/parallel.hpp"
#include "sparse/dense_kernels.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr Eigen::Index kFewestRows = 16;  // below these, dense kernels do not pay

// Slabs that are solved for at once: what they add is held until all are done, and then added in
// order.
constexpr Index kSlabsAtOnce = 8;

}  // namespace

template <int Dof>
HalfSolve<Dof>::HalfSolve(const FrontTree& tree, Index front, std::span<const Pair> pairs,
                          Eigen::Index most_entries)
    : tree_(tree), front_(front), pairs_(pairs), place_(tree.block_count(), FrontTree::kNone) {
  std::vector<bool> wanted(tree.front_count(), false);
  wanted[front] = true;
  fronts_.push_back(front);
  for (const auto& [a, b] : pairs) {
    for (const Index block : {a, b}) {
      for (Index f = tree.front_of(block); !wanted[f]; f = tree.parent(f)) {
        wanted[f] = true;
        fronts_.push_back(f);
      }
    }
  }
  std::ranges::sort(fronts_, std::greater());
  Index count = 0;
  for (const Index f : fronts_) {
    for (Index k = 0; k < tree.width(f); ++k) place_[tree.row(f, k)] = count++;
  }
  columns_ = Eigen::Index{count} * Dof;
  slab_rows_ = std::max(kFewestRows, most_entries / columns_);
  const Eigen::Index rows = Eigen::Index{tree.width(front)} * Dof;
  slab_count_ = static_cast<Index>((rows + slab_rows_ - 1) / slab_rows_);
}

template <int Dof>
std::vector<typename HalfSolve<Dof>::Block> HalfSolve<Dof>::products(int threads) const {
  std::vector<Block> sums(pairs_.size(), Block::Zero());
  std::vector<Slab> slabs(isotherm::detail::slot_count(threads));
  std::vector<std::vector<Block>> of_slab(std::min(kSlabsAtOnce, slab_count_), sums);
  for (Index first = 0; first < slab_count_; first += kSlabsAtOnce) {
    const Index count = std::min(kSlabsAtOnce, slab_count_ - first);
    const auto multiply = [&](std::size_t slot, std::int64_t at) {
      solve(first + static_cast<Index>(at), slabs[slot]);
      for (std::size_t k = 0; k < pairs_.size(); ++k) {
        const auto x_a = columns_of(pairs_[k].first, slabs[slot]);
        of_slab[at][k] = x_a.transpose().lazyProduct(columns_of(pairs_[k].second, slabs[slot]));
      }
    };
    isotherm::detail::parallel_by_slot(count, 1, threads, {}, "covariances", multiply);
    for (Index at = 0; at < count; ++at) {
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += of_slab[at][k];
    }
  }
  return sums;
}

template <int Dof>
void HalfSolve<Dof>::solve(Index number, Slab& slab) const {
  const Eigen::Index all = Eigen::Index{tree_.width(front_)} * Dof;
  slab.first = number * slab_rows_;
  slab.x.resize(std::min(slab_rows_, all - slab.first), columns_);
  for (const Index f : fronts_) solve_front(f, slab);
}

template <int Dof>
void HalfSolve<Dof>::solve_front(Index front, Slab& slab) const {
  auto& [first, x, above] = slab;
  const auto L = tree_.values(front);
  const Index width = tree_.width(front);
  // Rows above the front that the object is of have no part in its rows of L^-1.
  Index inside = width;
  above.resize(x.rows(), L.rows() - L.cols());
  for (; inside < tree_.size(front); ++inside) {
    const Index place = place_[tree_.row(front, inside)];
    if (place == FrontTree::kNone) break;
    above.template middleCols<Dof>((inside - width) * Dof) =
        x.template middleCols<Dof>(place * Dof);
  }
  const Eigen::Index used = Eigen::Index{inside - width} * Dof;
  auto own = x.middleCols(place_[tree_.row(front, 0)] * Dof, L.cols());
  own.setZero();
  if (front == front_) own.middleCols(first, x.rows()).setIdentity();
  add_product(own, -1.0, above.leftCols(used), L.middleRows(L.cols(), used));
  solve_lower_from_right(L.topRows(L.cols()), own);
}

template class HalfSolve<2>;
template class HalfSolve<3>;
template class HalfSolve<6>;

}  // namespace isotherm::spectral::detail
