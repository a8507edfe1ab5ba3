#include "localize/start/redraw.hpp"

#include <algorithm>
#include <utility>

#include "localize/constants.hpp"
#include "localize/start/anchor_frame.hpp"

namespace isotherm::network::detail {
namespace {

struct Region {
  std::vector<Index> nodes;
  std::vector<bool> outermost;  // one a node
};

// Placed nodes by steps over trusted pairs.
Region region_around(const MapTask& task, const Placement& placement, Index middle) {
  Region region{{middle}, {}};
  std::vector<bool> seen(task.problem.nodes, false);
  seen[middle] = true;
  std::size_t last = 0;  // the first node of the last step
  for (int step = 0; step < kRegionSteps; ++step) {
    const std::size_t end = region.nodes.size();
    for (std::size_t k = last; k < end; ++k) {
      task.visit_neighbours(placement, region.nodes[k], [&](Index vertex, Index) {
        if (seen[vertex]) return;
        seen[vertex] = true;
        region.nodes.push_back(vertex);
      });
    }
    last = end;
  }
  for (std::size_t k = 0; k < region.nodes.size(); ++k) region.outermost.push_back(k >= last);
  return region;
}

// The region as a network of pairs; its outermost nodes, and anchors, are its anchors.
struct Part {
  RangeProblem problem;
  std::vector<bool> trusted;
  Placement placement;

  Part(const MapTask& task, const Placement& everywhere, const Region& region) {
    const RangeProblem& whole = task.problem;
    std::vector<Index> number(whole.nodes, -1);
    for (const Index v : region.nodes) {
      number[v] = problem.nodes++;
      problem.is_anchor.push_back(whole.is_anchor[v] || region.outermost[number[v]]);
    }
    problem.dimension = whole.dimension;
    problem.typical_distance = whole.typical_distance;
    problem.typical_sigma = whole.typical_sigma;
    std::vector<spectral::WeightedEdge> edges;
    for (std::size_t p = 0; p < whole.pairs.size(); ++p) {
      auto pair = whole.pairs[p];
      pair.from = number[pair.from];
      pair.to = number[pair.to];
      if (pair.from < 0 || pair.to < 0) continue;
      problem.pairs.push_back(pair);
      edges.push_back({pair.from, pair.to, 1.0});
      trusted.push_back(task.trusted[p]);
    }
    problem.pair_graph = spectral::WeightedGraph(problem.nodes, edges);
    placement.positions = everywhere.positions(Eigen::all, region.nodes);
    placement.placed.assign(region.nodes.size(), true);
  }
};

// Nothing where its outermost nodes do not say where it lies.
Placement draw(const Part& part, const MapTask& task) {
  auto free = part.problem;
  free.is_anchor.assign(free.nodes, false);
  auto quiet = task.options;
  quiet.progress = {};
  auto map = map_by_paths({free, part.trusted, task.gate, quiet}, Errors::any);
  if (!align_to_anchors(part.problem, part.placement, map)) return {};
  return map;
}

}  // namespace

Placement redraw(const MapTask& task, const std::vector<bool>& among, const Placement& placement) {
  const RangeProblem& problem = task.problem;
  std::vector<int> against(problem.nodes, 0);
  task.visit_pairs(placement, [&](const RangePair& pair) {
    if (task.fits(placement, pair)) return;
    ++against[pair.from];
    ++against[pair.to];
  });
  std::vector<Index> order;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (among[v] && against[v] > 0) order.push_back(v);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return against[a] > against[b]; });
  std::vector<Region> regions;
  std::vector<bool> drawn(problem.nodes, false);
  for (const Index middle : order) {
    if (drawn[middle]) continue;
    regions.push_back(region_around(task, placement, middle));
    const auto& region = regions.back();
    for (std::size_t k = 0; k < region.nodes.size(); ++k) {
      if (!region.outermost[k]) drawn[region.nodes[k]] = true;
    }
  }
  std::vector<Placement> maps(regions.size());
  task.in_parallel(regions.size(), "regions", [&](std::int64_t k) {
    maps[k] = draw(Part(task, placement, regions[k]), task);
  });
  auto result = placement;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (maps[k].placed.empty()) continue;
    for (std::size_t i = 0; i < regions[k].nodes.size(); ++i) {
      const Index v = regions[k].nodes[i];
      if (problem.is_anchor[v] || regions[k].outermost[i] || !maps[k].placed[i]) continue;
      result.positions.col(v) = maps[k].positions.col(static_cast<Eigen::Index>(i));
    }
  }
  return result;
}

}  // namespace isotherm::network::detail
