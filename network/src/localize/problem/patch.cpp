#include "localize/problem/patch.hpp"

#include <algorithm>
#include <utility>

#include "isotherm/base/parallel.hpp"
#include "localize/problem/small_network.hpp"

namespace isotherm::network::detail {
namespace {

// Deviations beyond which a range in a patch is taken for false.
constexpr double kWidth = 3.0;
constexpr int kIterations = 30;

}  // namespace

std::vector<SmallRange> inner_ranges(const RangeProblem& problem, const std::vector<bool>& trusted,
                                     const std::vector<Index>& members) {
  std::vector<SmallRange> ranges;
  for (std::size_t a = 0; a < members.size(); ++a) {
    for (const auto& [vertex, edge] : problem.pair_graph.neighbours(members[a])) {
      if (!trusted[edge] || vertex < members[a]) continue;
      const auto b = std::lower_bound(members.begin(), members.end(), vertex);
      if (b == members.end() || *b != vertex) continue;
      const auto& pair = problem.pairs[edge];
      ranges.push_back(
          {static_cast<int>(a), static_cast<int>(b - members.begin()), pair.distance, pair.sigma});
    }
  }
  return ranges;
}

namespace {

// Drops members with too few pairs inside until all have enough.
void keep_rigid_core(const RangeProblem& problem, const std::vector<bool>& trusted,
                     std::vector<Index>& members) {
  for (;;) {
    std::vector<int> degree(members.size(), 0);
    for (const auto& range : inner_ranges(problem, trusted, members)) {
      ++degree[range.from];
      ++degree[range.to];
    }
    const int needed = std::min(problem.dimension + 1, static_cast<int>(members.size()) - 1);
    std::vector<Index> kept;
    for (std::size_t k = 0; k < members.size(); ++k) {
      if (degree[k] >= needed) kept.push_back(members[k]);
    }
    if (kept.size() == members.size()) return;
    members = std::move(kept);
  }
}

Patch place(const RangeProblem& problem, const std::vector<bool>& trusted,
            std::vector<Index> members) {
  keep_rigid_core(problem, trusted, members);
  if (static_cast<int>(members.size()) <= problem.dimension) return {};
  SmallNetwork network;
  network.positions.setZero(problem.dimension, static_cast<Eigen::Index>(members.size()));
  network.ranges = inner_ranges(problem, trusted, members);
  if (!place_by_scaling(network)) return {};
  fit_robustly(network, kWidth, kIterations);
  return {std::move(members), std::move(network.positions)};
}

// The centre and its closest trusted neighbours, at most `limit` nodes.
std::vector<Index> closest_neighbours(const RangeProblem& problem, const std::vector<bool>& trusted,
                                      Index centre, int limit) {
  std::vector<std::pair<double, Index>> neighbours;
  for (const auto& [vertex, edge] : problem.pair_graph.neighbours(centre)) {
    if (trusted[edge]) neighbours.emplace_back(problem.pairs[edge].distance, vertex);
  }
  std::sort(neighbours.begin(), neighbours.end());
  if (static_cast<int>(neighbours.size()) >= limit) neighbours.resize(limit - 1);
  std::vector<Index> members = {centre};
  for (const auto& neighbour : neighbours) members.push_back(neighbour.second);
  std::sort(members.begin(), members.end());
  return members;
}

}  // namespace

int Patch::find(Index node) const {
  const auto found = std::lower_bound(members.begin(), members.end(), node);
  if (found == members.end() || *found != node) return -1;
  return static_cast<int>(found - members.begin());
}

std::vector<Patch> make_patches(const RangeProblem& problem, const std::vector<bool>& trusted,
                                const LocalizeOptions& options) {
  std::vector<Patch> patches(problem.nodes);
  if (problem.nodes <= options.patch_size) {
    std::vector<Index> all(problem.nodes);
    for (Index v = 0; v < problem.nodes; ++v) all[v] = v;
    auto whole = place(problem, trusted, all);
    if (whole.empty()) return patches;
    const Index owner = whole.members.front();
    patches[owner] = std::move(whole);
    return patches;
  }
  parallel_for(problem.nodes, options.threads, options.progress, "local maps",
               [&](std::int64_t index) {
                 const auto centre = static_cast<Index>(index);
                 auto members = closest_neighbours(problem, trusted, centre, options.patch_size);
                 keep_rigid_core(problem, trusted, members);
                 auto patch = place(problem, trusted, std::move(members));
                 if (patch.find(centre) >= 0) patches[index] = std::move(patch);
               });
  return patches;
}

}  // namespace isotherm::network::detail
