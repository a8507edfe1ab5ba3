#include "sparse/inverse/front_tree.hpp"

#include <algorithm>

namespace isotherm::spectral {

FrontTree::FrontTree(const BlockCholesky& factor)
    : factor_(factor.supernodes()),
      block_size_(factor.block_size()),
      position_(static_cast<std::size_t>(factor.block_count())),
      block_at_(position_.size()),
      front_at_(position_.size()) {
  if (position_.empty()) return;  // nothing was factorised
  const int d = block_size_;
  for (std::size_t at = 0; at < factor_.order.size(); at += d) {
    const auto position = static_cast<Index>(at / d);
    block_at_[position] = factor_.order[at] / d;
    position_[block_at_[position]] = position;
  }
  for (const int column : factor_.first_column) first_column_.push_back(column / d);
  for (const int start : factor_.row_start) row_start_.push_back(start / d);
  const auto fronts = static_cast<Index>(first_column_.size()) - 1;
  for (Index f = 0; f < fronts; ++f) {
    std::fill(front_at_.begin() + first_column_[f], front_at_.begin() + first_column_[f + 1], f);
  }

  parent_.assign(fronts, kNone);
  place_in_parent_.assign(row_start_.back(), kNone);
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

FrontTree::Values FrontTree::values(Index front) const {
  const Eigen::Index rows = Eigen::Index{size(front)} * block_size_;
  const Eigen::Index columns = Eigen::Index{width(front)} * block_size_;
  return {factor_.values.data() + factor_.value_start[front], rows, columns,
          Eigen::OuterStride<>(rows)};
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

}  // namespace isotherm::spectral
