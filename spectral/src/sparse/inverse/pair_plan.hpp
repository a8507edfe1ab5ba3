#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sparse/inverse/front_tree.hpp"

namespace isotherm::spectral::detail {

/// Which fronts lead to some pairs of block rows, and where and how the block of Z = A^-1
/// between the two of each is best found.
class PairPlan {
 public:
  using Pair = std::pair<Index, Index>;

  /// A negative row of a pair stands for one that A does not have.
  PairPlan(const FrontTree& tree, std::span<const Pair> pairs);

  /// Whether a front is on the way from a root to a row that is asked for.
  bool wanted(Index front) const { return wanted_[front]; }

  /// Numbers of the pairs that a front holds, being the first to eliminate one of the two:
  /// all that are in the pattern of L. Ascending.
  std::span<const std::size_t> held_by(Index front) const { return held_.at(front); }

  /// Numbers of the other pairs, by the front where their branches meet, ascending.
  std::span<const std::size_t> meeting_at(Index front) const { return meeting_.at(front); }

  /// Whether the pairs that meet at a front are answered by rows of L^-1, of the front
  /// and of those above it, which all are half-solved then. Where many pairs meet, that
  /// takes less time than carrying each of them up from below.
  bool half_solved(Index front) const { return half_solved_[front]; }

 private:
  /// Numbers of pairs, by front.
  struct ByFront {
    ByFront(const std::vector<Index>& front_of_pair, Index fronts);
    std::span<const std::size_t> at(Index front) const {
      return {pairs.begin() + first[front], pairs.begin() + first[front + 1]};
    }

    std::vector<std::size_t> pairs;
    std::vector<std::size_t> first;  // one a front and an end
  };

  static ByFront held(const FrontTree& tree, std::span<const Pair> pairs);
  static ByFront meeting(const FrontTree& tree, std::span<const Pair> pairs);
  void find_wanted_fronts(const FrontTree& tree, std::span<const Pair> pairs);
  void choose_half_solved(const FrontTree& tree, std::span<const Pair> pairs);

  ByFront held_;
  ByFront meeting_;
  std::vector<bool> wanted_;
  std::vector<bool> half_solved_;
};

}  // namespace isotherm::spectral::detail
