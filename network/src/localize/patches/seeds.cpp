#include "localize/patches/seeds.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "isotherm/base/parallel.hpp"
#include "localize/problem/small_network.hpp"

namespace isotherm::network::detail {
namespace {

using Adjacency = std::vector<std::vector<Index>>;

Adjacency trusted_neighbours(const RangeProblem& problem, const std::vector<bool>& trusted) {
  Adjacency neighbours(problem.nodes);
  for (std::size_t p = 0; p < problem.pairs.size(); ++p) {
    if (!trusted[p]) continue;
    neighbours[problem.pairs[p].from].push_back(problem.pairs[p].to);
    neighbours[problem.pairs[p].to].push_back(problem.pairs[p].from);
  }
  for (auto& row : neighbours) std::sort(row.begin(), row.end());
  return neighbours;
}

std::vector<Index> common(const std::vector<Index>& a, const std::vector<Index>& b) {
  std::vector<Index> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

// The node with, again and again, the common neighbour that leaves the most of them.
std::vector<Index> greedy_clique(const Adjacency& neighbours, Index start, std::size_t limit) {
  std::vector<Index> members = {start};
  auto candidates = neighbours[start];
  while (!candidates.empty() && members.size() < limit) {
    Index best = -1;
    std::vector<Index> left;
    for (const Index candidate : candidates) {
      auto remaining = common(candidates, neighbours[candidate]);
      if (best >= 0 && remaining.size() <= left.size()) continue;
      best = candidate;
      left = std::move(remaining);
    }
    members.push_back(best);
    candidates = std::move(left);
  }
  std::sort(members.begin(), members.end());
  return members;
}

// Whether the points lie on a line (plane, in space) but for the noise.
bool is_flat(const SmallNetwork& network) {
  constexpr double kClear = 3.0;  // standard deviations
  std::vector<double> sigmas;
  for (const auto& range : network.ranges) sigmas.push_back(range.sigma);
  return extents(network.positions).minCoeff() <= kClear * lower_median(sigmas);
}

void remove_member(SmallNetwork& network, std::vector<Index>& members, int gone) {
  members.erase(members.begin() + gone);
  std::erase_if(network.ranges,
                [gone](const SmallRange& range) { return range.from == gone || range.to == gone; });
  for (auto& range : network.ranges) {
    if (range.from > gone) --range.from;
    if (range.to > gone) --range.to;
  }
  const auto rest = network.positions.cols() - gone - 1;
  network.positions.middleCols(gone, rest) = network.positions.rightCols(rest).eval();
  network.positions.conservativeResize(Eigen::NoChange, network.positions.cols() - 1);
}

// Drops members until all of the rest have most of their ranges agreeing, and enough to
// be checked.
void keep_agreeing(SmallNetwork& network, std::vector<Index>& members, double gate) {
  const auto d = static_cast<int>(network.positions.rows());
  for (;;) {
    std::vector<int> balance(members.size(), 0);
    std::vector<int> agree(members.size(), 0);
    for (const auto& range : network.ranges) {
      const bool within = std::pow(deviation(network, range), 2) <= gate;
      for (const int end : {range.from, range.to}) {
        agree[end] += within ? 1 : 0;
        balance[end] += within ? 1 : -2;
      }
    }
    const auto worst = std::min_element(balance.begin(), balance.end()) - balance.begin();
    if (agree[worst] > d && balance[worst] > 0) return;
    remove_member(network, members, static_cast<int>(worst));
    if (static_cast<int>(members.size()) < d + 2) return;
  }
}

Patch map_clique(const RangeProblem& problem, const std::vector<bool>& trusted,
                 std::vector<Index> members, double gate) {
  constexpr int kIterations = 30;
  const auto enough = static_cast<std::size_t>(problem.dimension + 2);
  if (members.size() < enough) return {};
  SmallNetwork network;
  network.positions.setZero(problem.dimension, static_cast<Eigen::Index>(members.size()));
  network.ranges = inner_ranges(problem, trusted, members);
  if (!place_by_scaling(network)) return {};
  fit_robustly(network, std::sqrt(gate), kIterations);
  keep_agreeing(network, members, gate);
  if (members.size() < enough || is_flat(network)) return {};
  return {std::move(members), std::move(network.positions)};
}

}  // namespace

std::vector<Patch> consistent_cliques(const RangeProblem& problem, const std::vector<bool>& trusted,
                                      double gate, const LocalizeOptions& options) {
  const auto neighbours = trusted_neighbours(problem, trusted);
  std::vector<Patch> cliques(problem.nodes);
  parallel_for(problem.nodes, options.threads, options.progress, "seeds", [&](std::int64_t v) {
    auto members = greedy_clique(neighbours, static_cast<Index>(v), options.patch_size);
    cliques[v] = map_clique(problem, trusted, std::move(members), gate);
  });
  std::erase_if(cliques, [](const Patch& clique) { return clique.empty(); });
  std::stable_sort(cliques.begin(), cliques.end(), [](const Patch& a, const Patch& b) {
    return a.members.size() > b.members.size();
  });
  return cliques;
}

}  // namespace isotherm::network::detail
