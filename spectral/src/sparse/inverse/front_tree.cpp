#include "sparse/inverse/front_tree.hpp"

#include <algorithm>

namespace isotherm::spectral::detail {

FrontTree::FrontTree(const BlockCholesky& factor)
    : FrontTree(factor.supernodes(), factor.block_size()) {}

FrontTree::FrontTree(const Supernodes& supernodes, int block_size)
    : block_size_(block_size),
      value_start_(supernodes.value_start),
      values_(supernodes.values),
      position_(supernodes.order.size() / block_size),
      block_at_(position_.size()),
      front_at_(position_.size()) {
  if (position_.empty()) return;  // nothing was factorised
  const int d = block_size_;
  for (std::size_t at = 0; at < supernodes.order.size(); at += d) {
    const auto position = static_cast<Index>(at / d);
    block_at_[position] = supernodes.order[at] / d;
    position_[block_at_[position]] = position;
  }
  for (const Index column : supernodes.first_column) first_column_.push_back(column / d);
  row_start_.push_back(0);
  for (std::size_t f = 0; f + 1 < supernodes.first_column.size(); ++f) {
    for (Index at = supernodes.row_start[f]; at < supernodes.row_start[f + 1]; at += d) {
      rows_.push_back(supernodes.rows[at] / d);
    }
    row_start_.push_back(static_cast<Index>(rows_.size()));
  }
  link_fronts();
}

void FrontTree::link_fronts() {
  const auto fronts = static_cast<Index>(row_start_.size()) - 1;
  for (Index f = 0; f < fronts; ++f) {
    std::fill(front_at_.begin() + first_column_[f], front_at_.begin() + first_column_[f + 1], f);
  }
  parent_.assign(fronts, kNone);
  place_in_parent_.assign(rows_.size(), kNone);
  for (Index f = 0; f < fronts; ++f) {
    Index k = width(f);
    if (k == size(f)) continue;
    const Index p = parent_[f] = front_at_[row(f, k)];
    for (Index place = 0; k < size(f); ++k, ++place) {
      while (row(p, place) != row(f, k)) ++place;
      place_in_parent_[row_start_[f] + k] = place;
    }
  }
}

Index FrontTree::place(Index front, Index block) const {
  const auto all = rows(front);
  const auto found = std::ranges::lower_bound(all, position_[block]);
  const bool there = found != all.end() && *found == position_[block];
  return there ? static_cast<Index>(found - all.begin()) : kNone;
}

FrontTree::Values FrontTree::values(Index front) const {
  const Eigen::Index rows = Eigen::Index{size(front)} * block_size_;
  const Eigen::Index columns = Eigen::Index{width(front)} * block_size_;
  return {values_.data() + value_start_[front], rows, columns, Eigen::OuterStride<>(rows)};
}

Index FrontTree::meeting(Index a, Index b) const {
  while (a != b && a != kNone && b != kNone) {
    if (a < b) {
      a = parent_[a];
    } else {
      b = parent_[b];
    }
  }
  return a == b ? a : kNone;
}

}  // namespace isotherm::spectral::detail
