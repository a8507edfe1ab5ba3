#include "prune/pcm/max_clique.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace isotherm::slam::detail {
namespace {

class CliqueSearch {
 public:
  CliqueSearch(const BitGraph& graph, std::int64_t budget) : graph_(graph), budget_(budget) {}

  Clique run() {
    std::vector<Index> order(static_cast<std::size_t>(graph_.vertex_count()));
    std::iota(order.begin(), order.end(), 0);
    std::vector<Index> degree(order.size());
    for (const Index v : order) degree[v] = graph_.degree(v);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return degree[a] > degree[b]; });
    for (const Index start : order) {
      if (degree[start] + 1 > static_cast<Index>(best_.size())) grow_greedily(start, order);
    }
    std::vector<Index> current;
    expand(current, order);
    make_maximal();
    std::sort(best_.begin(), best_.end());
    return {best_, budget_ > 0};
  }

 private:
  void grow_greedily(Index start, const std::vector<Index>& order) {
    std::vector<Index> clique = {start};
    for (const Index v : order) {
      if (v == start) continue;
      const bool fits = std::all_of(clique.begin(), clique.end(),
                                    [&](Index member) { return graph_.connected(v, member); });
      if (fits) clique.push_back(v);
    }
    if (clique.size() > best_.size()) best_ = std::move(clique);
  }

  // A search that ran out of budget may leave members to add.
  void make_maximal() {
    for (Index v = 0; v < graph_.vertex_count(); ++v) {
      const bool fits = std::all_of(best_.begin(), best_.end(), [&](Index member) {
        return member != v && graph_.connected(v, member);
      });
      if (fits) best_.push_back(v);
    }
  }

  // Orders `candidates` by colour class; a clique among the first k of them has at
  // most colours[k - 1] members.
  std::vector<std::size_t> colour(std::vector<Index>& candidates) const {
    std::vector<std::vector<Index>> classes;
    for (const Index v : candidates) {
      auto free = std::find_if(classes.begin(), classes.end(), [&](const auto& members) {
        return std::none_of(members.begin(), members.end(),
                            [&](Index member) { return graph_.connected(v, member); });
      });
      if (free == classes.end()) {
        classes.emplace_back();
        free = classes.end() - 1;
      }
      free->push_back(v);
    }
    std::vector<std::size_t> colours;
    candidates.clear();
    for (std::size_t c = 0; c < classes.size(); ++c) {
      candidates.insert(candidates.end(), classes[c].begin(), classes[c].end());
      colours.resize(candidates.size(), c + 1);
    }
    return colours;
  }

  void expand(std::vector<Index>& current, std::vector<Index> candidates) {
    const auto colours = colour(candidates);
    while (!candidates.empty()) {
      if (--budget_ <= 0) return;
      if (current.size() + colours[candidates.size() - 1] <= best_.size()) return;
      const Index v = candidates.back();
      candidates.pop_back();
      current.push_back(v);
      std::vector<Index> narrowed;
      for (const Index other : candidates) {
        if (graph_.connected(v, other)) narrowed.push_back(other);
      }
      if (narrowed.empty()) {
        if (current.size() > best_.size()) best_ = current;
      } else {
        expand(current, std::move(narrowed));
      }
      current.pop_back();
    }
  }

  const BitGraph& graph_;
  std::int64_t budget_;
  std::vector<Index> best_;
};

}  // namespace

Index BitGraph::degree(Index vertex) const {
  Index count = 0;
  for (std::size_t w = 0; w < words_; ++w) count += std::popcount(bits_[row(vertex) + w]);
  return count;
}

Clique max_clique(const BitGraph& graph, std::int64_t budget) {
  return CliqueSearch(graph, budget).run();
}

}  // namespace isotherm::slam::detail
