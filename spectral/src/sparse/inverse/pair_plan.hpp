#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sparse/inverse/front_tree.hpp"

namespace isotherm::spectral::detail {

/// Which fronts lead to some pairs of block rows, where the branches of each pair meet,
/// and how the blocks of Z = A^-1 between them are best found there.
class PairPlan {
 public:
  using Pair = std::pair<Index, Index>;

  /// A negative row of a pair stands for one that A does not have.
  PairPlan(const FrontTree& tree, std::span<const Pair> pairs);

  /// Whether a front is on the way from a root to a row that is asked for.
  bool wanted(Index front) const { return wanted_[front]; }

  /// Numbers of the pairs whose branches meet at a front, ascending.
  std::span<const std::size_t> meeting_at(Index front) const {
    return {by_meeting_.begin() + first_pair_[front], by_meeting_.begin() + first_pair_[front + 1]};
  }

  /// Whether the pairs that meet at a front are answered by rows of L^-1, of the front
  /// and of those above it, which all are half-solved then. Where many pairs meet, that
  /// takes less time than carrying each of them up from below.
  bool half_solved(Index front) const { return half_solved_[front]; }

 private:
  void sort_pairs_by_meeting(const FrontTree& tree, std::span<const Pair> pairs);
  void find_wanted_fronts(const FrontTree& tree, std::span<const Pair> pairs);
  void choose_half_solved(const FrontTree& tree, std::span<const Pair> pairs);

  std::vector<std::size_t> by_meeting_;  // pairs, by the front where their branches meet
  std::vector<std::size_t> first_pair_;  // places in by_meeting_, one a front and an end
  std::vector<bool> wanted_;
  std::vector<bool> half_solved_;
};

}  // namespace isotherm::spectral::detail
