#include "prune/consensus/pairs/conflicts.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <nanoflann.hpp>

#include "isotherm/base/parallel.hpp"
#include "matrices/decompositions.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr std::size_t kLookedAt = 8;  // nearest accepted loops
constexpr std::size_t kNamed = 3;

using Chains = std::pair<Index, Index>;

template <class Pose>
Chains chains_of(const ReducedGraph<Pose>& graph, const ForwardLoop<Pose>& loop) {
  return {graph.odometry.chain(loop.from), graph.odometry.chain(loop.to)};
}

// Accepted loops of one pair of chains as points (from, to), as nanoflann reads them.
struct LoopEnds {
  std::vector<std::array<Index, 2>> ends;
  std::vector<Index> loop;

  std::size_t kdtree_get_point_count() const { return ends.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const { return ends[index][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

// Loops are as far apart as the steps of odometry between their ends.
class AcceptedLoops {
 public:
  explicit AcceptedLoops(LoopEnds ends) : ends_(std::move(ends)), tree_(2, ends_) {}
  AcceptedLoops(const AcceptedLoops&) = delete;  // the tree refers to the ends
  AcceptedLoops& operator=(const AcceptedLoops&) = delete;

  std::vector<Index> nearest(Index from, Index to) const {
    const std::array<double, 2> place = {static_cast<double>(from), static_cast<double>(to)};
    std::array<std::size_t, kLookedAt> found{};
    std::array<double, kLookedAt> distance{};
    const std::size_t count =
        tree_.knnSearch(place.data(), kLookedAt, found.data(), distance.data());
    std::vector<Index> loops;
    for (std::size_t k = 0; k < count; ++k) loops.push_back(ends_.loop[found[k]]);
    return loops;
  }

 private:
  using Distance = nanoflann::L1_Adaptor<double, LoopEnds>;

  LoopEnds ends_;
  nanoflann::KDTreeSingleIndexAdaptor<Distance, LoopEnds, 2, std::size_t> tree_;
};

template <class Pose>
double pair_chi2(const ReducedGraph<Pose>& graph, const CovarianceScale& scale,
                 const ForwardLoop<Pose>& known, const ForwardLoop<Pose>& measured) {
  const auto [r, S] = pair_residual(graph, scale, known, measured);
  return r.dot(Eigen::LLT<typename Pose::Matrix>(S).solve(r));
}

template <class Pose>
std::vector<std::vector<Index>> named_in(const std::map<Chains, AcceptedLoops>& groups,
                                         const ReducedGraph<Pose>& graph,
                                         const CovarianceScale& scale, double gate,
                                         const std::vector<ForwardLoop<Pose>>& loops,
                                         const std::vector<bool>& refuted, int threads) {
  std::vector<std::vector<Index>> conflicts(loops.size());
  parallel_for_each(loops.size(), threads, [&](std::size_t k) {
    const auto group = groups.find(chains_of(graph, loops[k]));
    if (!refuted[k] || group == groups.end()) return;
    const auto near = group->second.nearest(loops[k].from, loops[k].to);
    auto& named = conflicts[k];
    for (const Index other : near) {
      if (named.size() == kNamed) break;
      if (pair_chi2(graph, scale, loops[other], loops[k]) > gate) named.push_back(other);
    }
    if (named.empty()) named.assign(near.begin(), near.begin() + std::min(near.size(), kNamed));
  });
  return conflicts;
}

}  // namespace

template <class Pose>
std::vector<std::vector<Index>> name_conflicts(const ReducedGraph<Pose>& graph,
                                               const CovarianceScale& scale, double gate,
                                               const std::vector<bool>& accepted,
                                               const std::vector<bool>& refuted, int threads) {
  const auto loops = forward_loops(graph, scale);
  std::map<Chains, LoopEnds> by_chains;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (!accepted[k]) continue;
    auto& group = by_chains[chains_of(graph, loops[k])];
    group.ends.push_back({loops[k].from, loops[k].to});
    group.loop.push_back(static_cast<Index>(k));
  }
  std::map<Chains, AcceptedLoops> groups;
  for (auto& [chains, ends] : by_chains) groups.try_emplace(chains, std::move(ends));

  return named_in(groups, graph, scale, gate, loops, refuted, threads);
}

template std::vector<std::vector<Index>> name_conflicts(const ReducedGraph<Pose2>&,
                                                        const CovarianceScale&, double,
                                                        const std::vector<bool>&,
                                                        const std::vector<bool>&, int);
template std::vector<std::vector<Index>> name_conflicts(const ReducedGraph<Pose3>&,
                                                        const CovarianceScale&, double,
                                                        const std::vector<bool>&,
                                                        const std::vector<bool>&, int);

}  // namespace isotherm::slam::detail
