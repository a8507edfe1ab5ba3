#include "prune/consensus/pairs/near_pairs.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>

#include "prune/consensus/pairs/loop_pair.hpp"

namespace isotherm::slam::detail {
namespace {

// More partners than this tell nothing new; the nearest are taken.
constexpr std::size_t kMostPartners = 12;

// Loops by cells of `window` x `window` vertices in the plane of (from, to).
class Cells {
 public:
  using Key = std::array<Index, 4>;  // chains and cell numbers of both ends

  Cells(Index window, std::size_t loops) : window_(window), key_(loops) {}

  // In ascending order. Of loops between the same two vertices only the first can be among
  // the nearest of any: thousands of copies are not looked at for each other.
  void add(Index loop, Index from_chain, Index to_chain, Index from, Index to) {
    key_[loop] = {from_chain, to_chain, from / window_, to / window_};
    if (++copies_[{from, to}] <= kMostPartners + 1) cells_[key_[loop]].push_back(loop);
  }

  template <class Visit>
  void for_each_near(Index loop, Visit visit) const {
    for (Index df = -1; df <= 1; ++df) {
      for (Index dt = -1; dt <= 1; ++dt) {
        Key key = key_[loop];
        key[2] += df;
        key[3] += dt;
        const auto found = cells_.find(key);
        if (found == cells_.end()) continue;
        for (const Index other : found->second) visit(other);
      }
    }
  }

 private:
  Index window_;
  std::vector<Key> key_;
  std::map<Key, std::vector<Index>> cells_;
  std::map<std::pair<Index, Index>, std::size_t> copies_;  // by the vertices they join
};

// For each loop those of the same chains within the window at both ends, nearest first.
template <class Pose>
class Neighbourhood {
 public:
  Neighbourhood(const ReducedGraph<Pose>& graph, const std::vector<ForwardLoop<Pose>>& loops,
                Index window)
      : loops_(loops), window_(window), cells_(window, loops.size()) {
    for (std::size_t k = 0; k < loops.size(); ++k) {
      cells_.add(static_cast<Index>(k), graph.odometry.chain(loops[k].from),
                 graph.odometry.chain(loops[k].to), loops[k].from, loops[k].to);
    }
  }

  std::vector<Index> partners(Index loop) const {
    std::vector<std::pair<Index, Index>> near;
    cells_.for_each_near(loop, [&](Index other) {
      if (other == loop) return;
      const Index df = std::abs(loops_[loop].from - loops_[other].from);
      const Index dt = std::abs(loops_[loop].to - loops_[other].to);
      if (std::max(df, dt) <= window_) near.emplace_back(df + dt, other);
    });
    const std::size_t count = std::min(near.size(), kMostPartners);
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    std::vector<Index> result;
    for (std::size_t k = 0; k < count; ++k) result.push_back(near[k].second);
    return result;
  }

 private:
  const std::vector<ForwardLoop<Pose>>& loops_;
  Index window_;
  Cells cells_;
};

}  // namespace

template <class Pose>
std::vector<std::pair<Index, Index>> near_pairs(const ReducedGraph<Pose>& graph, Index window) {
  const auto loops = forward_loops(graph, {});
  const Neighbourhood<Pose> neighbourhood(graph, loops, window);
  std::vector<std::pair<Index, Index>> pairs;
  for (Index loop = 0; loop < static_cast<Index>(graph.loops.size()); ++loop) {
    for (const Index other : neighbourhood.partners(loop)) {
      pairs.emplace_back(std::min(loop, other), std::max(loop, other));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

template std::vector<std::pair<Index, Index>> near_pairs(const ReducedGraph<Pose2>&, Index);
template std::vector<std::pair<Index, Index>> near_pairs(const ReducedGraph<Pose3>&, Index);

}  // namespace isotherm::slam::detail
