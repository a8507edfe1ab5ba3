#include "sparse/inverse/pair_plan.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace isotherm::spectral::detail {

namespace {

// The front that eliminates the first row of a pair, if the other one is among its rows.
Index holder(const FrontTree& tree, Index a, Index b) {
  if (a < 0 || b < 0) return FrontTree::kNone;
  if (tree.position(b) < tree.position(a)) std::swap(a, b);
  const Index front = tree.front_of(a);
  return tree.place(front, b) == FrontTree::kNone ? FrontTree::kNone : front;
}

}  // namespace

PairPlan::PairPlan(const FrontTree& tree, std::span<const Pair> pairs)
    : held_(held(tree, pairs)), meeting_(meeting(tree, pairs)) {
  find_wanted_fronts(tree, pairs);
  choose_half_solved(tree, pairs);
}

PairPlan::ByFront::ByFront(const std::vector<Index>& front_of_pair, Index fronts)
    : pairs(front_of_pair.size()), first(fronts + 1, 0) {
  std::iota(pairs.begin(), pairs.end(), std::size_t{0});
  std::ranges::stable_sort(pairs, {}, [&](std::size_t k) { return front_of_pair[k]; });
  for (const Index front : front_of_pair) ++first[front + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
}

PairPlan::ByFront PairPlan::held(const FrontTree& tree, std::span<const Pair> pairs) {
  std::vector<Index> front;
  front.reserve(pairs.size());
  for (const auto& [a, b] : pairs) front.push_back(holder(tree, a, b));
  return {front, tree.front_count()};
}

PairPlan::ByFront PairPlan::meeting(const FrontTree& tree, std::span<const Pair> pairs) {
  std::vector<Index> front;
  front.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    const bool apart = a >= 0 && b >= 0 && holder(tree, a, b) == FrontTree::kNone;
    front.push_back(apart ? tree.meeting(tree.front_of(a), tree.front_of(b)) : FrontTree::kNone);
  }
  return {front, tree.front_count()};
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
    double carried = 0.0;
    for (const std::size_t k : meeting_at(f)) {
      const Index a = tree.front_of(pairs[k].first);
      const Index b = tree.front_of(pairs[k].second);
      carried += to_root[a] + to_root[b] - 2.0 * to_root[f];
      if (a != f && b != f) carried += 2.0 * tree.size(f) * tree.size(f);
      row_cost[f] += 1.0;
    }
    saved[f] += carried - tree.width(f) * row_cost[f];
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
