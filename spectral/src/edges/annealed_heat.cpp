#include "edges/annealed_heat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "edges/control_pairs.hpp"
#include "edges/planar/plane_scores.hpp"
#include "edges/two_groups.hpp"
#include "graph/bridges.hpp"
#include "graph/series_reduction.hpp"
#include "graph/simple_graph.hpp"
#include "heat/walk_affinity.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr int kLongestDetour = 12;
constexpr double kBudget = 1e9;  // steps along edges a round
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

/// Every so manieth pair, so that about a few thousand are left: enough for a rate.
std::vector<VertexPair> thin_out(const std::vector<VertexPair>& pairs) {
  constexpr std::size_t kAbout = 5000;
  const std::size_t stride = pairs.size() / kAbout + 1;
  std::vector<VertexPair> thin;
  for (std::size_t k = 0; k < pairs.size(); k += stride) thin.push_back(pairs[k]);
  return thin;
}

/// Judges the edges once more by what they cross, where the graph is nearly planar.
void judge_in_plane(const WeightedGraph& graph, std::span<const double> lengths,
                    const std::vector<VertexPair>& pairs, const WalkAffinityOptions& walks,
                    AnnealedHeat& result) {
  const auto scores = plane_scores(graph, lengths, result.scores, thin_out(pairs), walks);
  if (!scores) return;
  auto groups = separate_groups(scores->edges, scores->pairs);
  result.scores = scores->edges;
  result.false_count = groups.false_count;
  result.truth = std::move(groups.truth);
  result.in_plane = true;
}

/// From judgements about chains, those about each of their edges. A score is lowered to
/// that of single edges that are as likely true.
void share_among_chains(std::span<const double> lengths, AnnealedHeat& result) {
  const auto order = by_suspicion(result.scores);
  const auto of_chains = result;
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    if (lengths[k] == 1.0) continue;
    result.truth[k] = 1.0 - (1.0 - of_chains.truth[k]) / lengths[k];
    const auto alike = std::partition_point(order.begin(), order.end(), [&](Index other) {
      return of_chains.truth[other] < result.truth[k];
    });
    if (alike != order.end()) {
      result.scores[k] = std::min(of_chains.scores[k], of_chains.scores[*alike]);
    }
  }
}

/// Judges the edges of a graph without bridges and chains.
AnnealedHeat anneal_reduced(const WeightedGraph& graph, std::span<const double> lengths,
                            const AnnealedHeatOptions& options) {
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
  judge_in_plane(graph, lengths, pairs,
                 {.scale = result.scale,
                  .horizon = result.horizon,
                  .threads = options.threads,
                  .progress = options.progress},
                 result);
  share_among_chains(lengths, result);
  result.threshold =
      rejection_threshold(result.scores, {result.truth, result.false_count}, options.chance);
  return result;
}

}  // namespace

AnnealedHeat anneal_heat(const WeightedGraph& graph, const AnnealedHeatOptions& options) {
  const auto simple = merge_parallel_edges(graph);
  const auto bridge = find_bridges(simple.graph);
  const auto reduction = reduce_series(simple.graph, bridge);
  const auto reduced = anneal_reduced(reduction.graph, reduction.lengths, options);
  AnnealedHeat result;
  result.false_count = reduced.false_count;
  result.threshold = reduced.threshold;
  result.scale = reduced.scale;
  result.horizon = reduced.horizon;
  result.in_plane = reduced.in_plane;
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
