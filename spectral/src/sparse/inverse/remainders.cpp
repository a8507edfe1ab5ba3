#include "sparse/inverse/remainders.hpp"

#include "sparse/dense_kernels.hpp"

namespace isotherm::spectral::detail {

template <int Dof>
Remainders<Dof>::Remainders(const FrontTree& tree, std::span<const Pair> pairs,
                            std::span<const std::size_t> batch, Index front)
    : tree_(tree) {
  for (const std::size_t k : batch) {
    start(pairs[k].first, front);
    start(pairs[k].second, front);
    const bool below = tree.front_of(pairs[k].first) != front;
    any_between_ = any_between_ || (below && tree.front_of(pairs[k].second) != front);
  }
  // A parent's number is above its children's.
  while (!groups_.empty() && groups_.begin()->first != front) {
    auto lowest = groups_.extract(groups_.begin());
    carry_up(lowest.key(), std::move(lowest.mapped()));
  }
  if (groups_.empty()) return;
  columns_ = std::move(groups_.begin()->second.x);
  const auto& blocks = groups_.begin()->second.blocks;
  for (std::size_t k = 0; k < blocks.size(); ++k) place_[blocks[k]] = static_cast<Index>(k);
}

// New columns, zero, of the group at a front.
template <int Dof>
auto Remainders<Dof>::append(Index front, std::span<const Index> blocks) {
  auto& group = groups_[front];
  const auto before = static_cast<Eigen::Index>(group.blocks.size()) * Dof;
  const auto added = static_cast<Eigen::Index>(blocks.size()) * Dof;
  group.blocks.insert(group.blocks.end(), blocks.begin(), blocks.end());
  group.x.conservativeResize(Eigen::Index{tree_.size(front)} * Dof, before + added);
  auto fresh = group.x.rightCols(added);
  fresh.setZero();
  return fresh;
}

template <int Dof>
void Remainders<Dof>::start(Index block, Index front) {
  const Index own = tree_.front_of(block);
  if (own == front || !place_.emplace(block, 0).second) return;
  auto x = append(own, {&block, 1});
  x.template middleRows<Dof>(tree_.column_of(block) * Dof).setIdentity();
}

template <int Dof>
void Remainders<Dof>::carry_up(Index front, Group group) {
  const auto L = tree_.values(front);
  const Eigen::Index width = L.cols();
  const Eigen::Index below = L.rows() - width;
  auto own = group.x.topRows(width);
  auto left = group.x.bottomRows(below);
  solve_lower(L.topRows(width), own);
  add_product(left, -1.0, L.bottomRows(below), own);
  auto target = append(tree_.parent(front), group.blocks);
  const auto places = tree_.place_in_parent(front);
  for (std::size_t k = 0; k < places.size(); ++k) {
    target.template middleRows<Dof>(places[k] * Dof) = left.template middleRows<Dof>(k * Dof);
  }
}

template class Remainders<2>;
template class Remainders<3>;
template class Remainders<6>;

}  // namespace isotherm::spectral::detail
