#include "sparse/block_order.hpp"

#include <algorithm>

namespace isotherm::spectral::detail {
namespace {

using Neighbours = std::vector<std::vector<Index>>;

Neighbours neighbours_of(Index count, std::span<const std::pair<Index, Index>> pairs) {
  Neighbours neighbours(static_cast<std::size_t>(count));
  for (const auto& [a, b] : pairs) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbours;
}

void replace(std::vector<Index>& list, Index before, Index after) {
  list.erase(std::find(list.begin(), list.end(), before));
  const auto at = std::lower_bound(list.begin(), list.end(), after);
  if (at == list.end() || *at != after) list.insert(at, after);
}

}  // namespace

ChainElimination eliminate_chains(Index count, std::span<const std::pair<Index, Index>> pairs) {
  Neighbours neighbours = neighbours_of(count, pairs);
  ChainElimination result;
  std::vector<bool> gone(neighbours.size(), false);
  std::vector<int> touched(neighbours.size(), -1);  // in which round last
  std::vector<Index> waiting(neighbours.size());
  for (Index v = 0; v < count; ++v) waiting[v] = v;
  for (int round = 0; !waiting.empty(); ++round) {
    std::vector<Index> later;
    for (const Index v : waiting) {
      if (gone[v] || neighbours[v].size() > 2) continue;
      if (touched[v] == round) {
        later.push_back(v);
        continue;
      }
      const auto& list = neighbours[v];
      for (const Index u : list) {
        if (list.size() == 2) {
          replace(neighbours[u], v, list.front() == u ? list.back() : list.front());
        } else {
          neighbours[u].erase(std::find(neighbours[u].begin(), neighbours[u].end(), v));
        }
        touched[u] = round;
        later.push_back(u);
      }
      gone[v] = true;
      result.order.push_back(v);
    }
    std::sort(later.begin(), later.end());
    later.erase(std::unique(later.begin(), later.end()), later.end());
    waiting = std::move(later);
  }

  std::vector<Index> place(neighbours.size(), -1);
  for (Index v = 0; v < count; ++v) {
    if (gone[v]) continue;
    place[v] = static_cast<Index>(result.core.size());
    result.core.push_back(v);
  }
  for (const Index v : result.core) {
    for (const Index u : neighbours[v]) {
      if (v < u) result.pairs.emplace_back(place[v], place[u]);
    }
  }
  return result;
}

}  // namespace isotherm::spectral::detail
