#include "sparse/inverse/pair_plan.hpp"

#include <algorithm>
#include <numeric>

namespace isotherm::spectral::detail {

PairPlan::PairPlan(const FrontTree& tree, std::span<const Pair> pairs) {
  sort_pairs_by_meeting(tree, pairs);
  find_wanted_fronts(tree, pairs);
  choose_half_solved(tree, pairs);
}

void PairPlan::sort_pairs_by_meeting(const FrontTree& tree, std::span<const Pair> pairs) {
  std::vector<Index> meeting(pairs.size(), FrontTree::kNone);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [a, b] = pairs[k];
    if (a >= 0 && b >= 0) meeting[k] = tree.meeting(tree.front_of(a), tree.front_of(b));
  }
  by_meeting_.resize(pairs.size());
  std::iota(by_meeting_.begin(), by_meeting_.end(), std::size_t{0});
  std::stable_sort(by_meeting_.begin(), by_meeting_.end(),
                   [&](std::size_t x, std::size_t y) { return meeting[x] < meeting[y]; });
  first_pair_.assign(tree.front_count() + 1, 0);
  for (const Index front : meeting) ++first_pair_[front + 1];
  std::partial_sum(first_pair_.begin(), first_pair_.end(), first_pair_.begin());
}

void PairPlan::find_wanted_fronts(const FrontTree& tree, std::span<const Pair> pairs) {
  wanted_.assign(tree.front_count(), false);
  for (const auto& [a, b] : pairs) {
    if (a >= 0) wanted_[tree.front_of(a)] = true;
    if (b >= 0) wanted_[tree.front_of(b)] = true;
  }
  for (Index f = 0; f < tree.front_count(); ++f) {
    if (wanted_[f] && tree.parent(f) != FrontTree::kNone) wanted_[tree.parent(f)] = true;
  }
}

// Both ways are counted in products of two blocks. Rows of L^-1 answer a pair once those
// of all fronts above are known as well, so that a front is chosen with its parent only.
void PairPlan::choose_half_solved(const FrontTree& tree, std::span<const Pair> pairs) {
  const Index fronts = tree.front_count();
  const auto entries = [&](Index f) { return double(tree.width(f)) * tree.size(f); };
  std::vector<double> to_root(fronts, 0.0);
  for (Index f = fronts - 1; f >= 0; --f) {
    const Index p = tree.parent(f);
    to_root[f] = entries(f) + (p == FrontTree::kNone ? 0.0 : to_root[p]);
  }
  std::vector<double> saved(fronts, 0.0);
  std::vector<double> row_cost(fronts, 0.0);  // of one row of blocks of L^-1
  for (Index f = 0; f < fronts; ++f) {
    for (const std::size_t k : meeting_at(f)) {
      const Index a = tree.front_of(pairs[k].first);
      const Index b = tree.front_of(pairs[k].second);
      saved[f] += to_root[a] + to_root[b] - 2.0 * to_root[f];
      if (a != f && b != f) saved[f] += 2.0 * tree.size(f) * tree.size(f);
      row_cost[f] += 1.0;
    }
    saved[f] -= tree.width(f) * row_cost[f];
    const Index p = tree.parent(f);
    if (!wanted_[f] || p == FrontTree::kNone) continue;
    saved[p] += std::max(0.0, saved[f]);
    row_cost[p] += row_cost[f] + entries(f);
  }
  half_solved_.assign(fronts, false);
  for (Index f = fronts - 1; f >= 0; --f) {
    const Index p = tree.parent(f);
    half_solved_[f] = saved[f] > 0.0 && (p == FrontTree::kNone || half_solved_[p]);
  }
}

}  // namespace isotherm::spectral::detail
