#include "annealed_heat.hpp"

#include <algorithm>
#include <cmath>

#include "bridges.hpp"
#include "control_pairs.hpp"
#include "series_reduction.hpp"
#include "simple_graph.hpp"
#include "two_groups.hpp"
#include "walk_affinity.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr int kLongestDetour = 12;
constexpr double kBudget = 2e9;  // steps along edges a round
constexpr double kFirstScale = 0.5;

/// Fewest steps between the ends of an edge without it, at most `most`; `most` + 1 if
/// it takes more.
int detour(const WeightedGraph& graph, Index edge, int most, std::vector<Index>& seen_by) {
  const auto& ends = graph.edge(edge);
  std::vector<Index> rim = {ends.from}, next;
  seen_by[ends.from] = edge;
  for (int steps = 1; steps <= most; ++steps) {
    next.clear();
    for (const Index vertex : rim) {
      for (const auto& [other, by] : graph.neighbours(vertex)) {
        if (by == edge || seen_by[other] == edge) continue;
        if (other == ends.to) return steps;
        seen_by[other] = edge;
        next.push_back(other);
      }
    }
    rim.swap(next);
  }
  return most + 1;
}

/// Three times the median detour, from a thousand edges spread evenly over the list:
/// most true edges see their other end, whatever size the graph's cycles have.
int first_horizon(const WeightedGraph& graph) {
  constexpr Index kSample = 1000;
  std::vector<Index> seen_by(graph.vertex_count(), -1);
  std::vector<int> detours;
  const Index stride = std::max<Index>(1, graph.edge_count() / kSample);
  for (Index e = 0; e < graph.edge_count(); e += stride) {
    detours.push_back(detour(graph, e, kLongestDetour, seen_by));
  }
  if (detours.empty()) return 1;
  const auto middle = detours.begin() + static_cast<std::ptrdiff_t>(detours.size() / 2);
  std::nth_element(detours.begin(), middle, detours.end());
  return 3 * *middle;
}

/// Scores of a round from its affinities and the scores of the round before.
void update_scores(const std::vector<double>& affinities, std::vector<double>& scores) {
  for (std::size_t k = 0; k < scores.size(); ++k) {
    scores[k] = affinities[k] > 0.0 ? -std::log(affinities[k]) : kNoWalk + scores[k];
  }
}

/// Judges the edges of a graph without bridges and chains.
AnnealedHeat anneal_reduced(const WeightedGraph& graph, const AnnealedHeatOptions& options) {
  AnnealedHeat result;
  result.scores.assign(graph.edges().size(), 0.0);
  result.truth.assign(graph.edges().size(), 1.0);
  const auto pairs = control_pairs(graph, options.control, options.seed);
  std::vector<double> pair_scores(pairs.size(), 0.0);
  auto trust = result.truth;
  const int horizon = first_horizon(graph);
  for (int round = 0; round < options.rounds; ++round) {
    result.scale = kFirstScale * std::exp2(round);
    result.horizon = affordable_horizon(graph, trust, horizon + round, kBudget);
    const auto affinities = walk_affinities(graph, trust, pairs,
                                            {.scale = result.scale,
                                             .horizon = result.horizon,
                                             .threads = options.threads,
                                             .progress = options.progress});
    update_scores(affinities.edges, result.scores);
    update_scores(affinities.pairs, pair_scores);
    auto groups = separate_groups(result.scores, pair_scores);
    result.false_count = groups.false_count;
    result.truth = std::move(groups.truth);
    for (std::size_t e = 0; e < trust.size(); ++e) {
      trust[e] = result.truth[e] < options.chance ? 0.0 : result.truth[e];
    }
  }
  return result;
}

}  // namespace

AnnealedHeat anneal_heat(const WeightedGraph& graph, const AnnealedHeatOptions& options) {
  const auto simple = merge_parallel_edges(graph);
  const auto bridge = find_bridges(simple.graph);
  const auto reduction = reduce_series(simple.graph, bridge);
  const auto reduced = anneal_reduced(reduction.graph, options);
  AnnealedHeat result;
  result.false_count = reduced.false_count;
  result.scale = reduced.scale;
  result.horizon = reduced.horizon;
  for (const Index edge : simple.merged) {
    const bool loop = edge == SimpleGraph::kNone;
    const Index chain = loop ? SeriesReduction::kNone : reduction.chains[edge];
    const bool judged = chain != SeriesReduction::kNone;
    result.scores.push_back(judged ? reduced.scores[chain] : 0.0);
    result.truth.push_back(judged ? reduced.truth[chain] : 1.0);
    result.bridge.push_back(!loop && bridge[edge]);
  }
  return result;
}

}  // namespace isotherm::spectral::detail
