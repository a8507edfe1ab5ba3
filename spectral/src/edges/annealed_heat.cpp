#include "edges/annealed_heat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "edges/control_pairs.hpp"
#include "edges/planar/plane_scores.hpp"
#include "edges/step_counter.hpp"
#include "edges/thin_out.hpp"
#include "edges/two_groups.hpp"
#include "graph/bridges.hpp"
#include "graph/series_reduction.hpp"
#include "graph/simple_graph.hpp"
#include "heat/walk_affinity.hpp"
#include "isotherm/base/parallel.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr int kLongestDetour = 12;
constexpr double kBudget = 1e9;  // steps along edges a round
constexpr double kFirstScale = 0.5;
// What a large change of judgement finds must be more likely false than true.
constexpr double kEven = 0.5;
constexpr double kMostFalse = 2.0 / 3.0;  // a graph with more would be none

/// Three times the median detour, from a thousand edges spread evenly over the list:
/// most true edges see their other end, whatever size the graph's cycles have.
int first_horizon(const WeightedGraph& graph) {
  constexpr Index kSample = 1000;
  const std::vector<double> trust(graph.edges().size(), 1.0);
  StepCounter steps(graph, trust);
  std::vector<int> detours;
  const Index stride = std::max<Index>(1, graph.edge_count() / kSample);
  for (Index e = 0; e < graph.edge_count(); e += stride) {
    detours.push_back(steps.count({graph.edge(e).from, graph.edge(e).to}, kLongestDetour, e));
  }
  if (detours.empty()) return 1;
  const auto middle = detours.begin() + static_cast<std::ptrdiff_t>(detours.size() / 2);
  std::nth_element(detours.begin(), middle, detours.end());
  return 3 * *middle;
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

/// Scores of the edges and of the control pairs, and the judgement that follows from them.
struct Judgement {
  std::vector<double> edges;
  std::vector<double> pairs;
  TwoGroups groups;
};

/// How ends that no walk joins are ordered.
enum class Unjoined { as_before, alike };

/// The rounds of one graph, which branch after the first.
class Rounds {
 public:
  Rounds(const WeightedGraph& graph, const AnnealedHeatOptions& options)
      : graph_(graph),
        options_(options),
        pairs_(control_pairs(graph, options.control, options.seed)),
        horizon_(first_horizon(graph)) {}

  const std::vector<VertexPair>& pairs() const { return pairs_; }

  WalkAffinityOptions walks(int round, const std::vector<double>& trust) const {
    return {.scale = kFirstScale * std::exp2(round),
            .horizon = affordable_horizon(graph_, trust, horizon_ + round, kBudget),
            .threads = options_.threads,
            .progress = options_.progress};
  }

  Judgement first() const {
    Judgement judgement;
    judgement.edges.assign(graph_.edges().size(), 0.0);
    judgement.pairs.assign(pairs_.size(), 0.0);
    judge(0, std::vector<double>(graph_.edges().size(), 1.0), Unjoined::as_before, judgement);
    return judgement;
  }

  /// The rounds after the first: edges are weighted by the judgement before.
  Judgement trusting(Judgement judgement) const {
    for (int round = 1; round < options_.rounds; ++round) {
      judge(round, trust_of(judgement), Unjoined::as_before, judgement);
    }
    return judgement;
  }

  /// The same, but the most suspicious edges vouch for none in the second round, whatever is
  /// thought of them; of ends that no walk joins the steps between them are counted at last.
  Judgement doubting(Judgement judgement) const {
    for (int round = 1; round < options_.rounds; ++round) {
      auto trust = trust_of(judgement);
      if (round == 1) leave_out_suspicious(judgement.edges, trust);
      judge(round, trust, Unjoined::alike, judgement);
      if (round + 1 == options_.rounds) count_steps(trust, walks(round, trust).horizon, judgement);
    }
    return judgement;
  }

 private:
  std::vector<double> trust_of(const Judgement& judgement) const {
    auto trust = judgement.groups.truth;
    for (double& p : trust) {
      if (p < options_.chance) p = 0.0;
    }
    return trust;
  }

  void judge(int round, const std::vector<double>& trust, Unjoined unjoined,
             Judgement& judgement) const {
    const auto affinities = walk_affinities(graph_, trust, pairs_, walks(round, trust));
    update_scores(affinities.edges, unjoined, judgement.edges);
    update_scores(affinities.pairs, unjoined, judgement.pairs);
    judgement.groups = separate_groups(judgement.edges, judgement.pairs, kMostFalse);
  }

  static void update_scores(const std::vector<double>& affinities, Unjoined unjoined,
                            std::vector<double>& scores) {
    for (std::size_t k = 0; k < scores.size(); ++k) {
      const double before = unjoined == Unjoined::as_before ? scores[k] : 0.0;
      scores[k] = affinities[k] > 0.0 ? -std::log(affinities[k]) : kNoWalk + before;
    }
  }

  /// Takes the trust of the most suspicious of the edges that have any.
  static void leave_out_suspicious(std::span<const double> scores, std::vector<double>& trust) {
    constexpr double kShare = 0.03;
    auto left = static_cast<std::size_t>(kShare * static_cast<double>(scores.size()));
    for (const Index edge : by_suspicion(scores)) {
      if (left == 0) break;
      if (trust[edge] > 0.0) --left;
      trust[edge] = 0.0;
    }
  }

  /// Puts the steps between them in place of the scores of ends that no walk joins.
  void count_steps(const std::vector<double>& trust, int horizon, Judgement& judgement) const {
    auto pair_scores = thin_out(judgement.pairs);
    const auto pairs = thin_out(pairs_);
    const auto edges = edge_pairs(graph_);
    const auto count = [&](StepCounter& steps, VertexPair pair, Index edge, double& score) {
      if (score >= kNoWalk) score = kNoWalk + steps.count(pair, 2 * horizon, edge);
    };
    const auto edge_count = static_cast<std::int64_t>(edges.size());
    parallel_for(
        edge_count + static_cast<std::int64_t>(pairs.size()), 256, options_.threads,
        options_.progress, "steps", [&] { return StepCounter(graph_, trust); },
        [&](StepCounter& steps, std::int64_t k) {
          if (k < edge_count) {
            count(steps, edges[k], static_cast<Index>(k), judgement.edges[k]);
          } else {
            count(steps, pairs[k - edge_count], -1, pair_scores[k - edge_count]);
          }
        });
    judgement.groups = separate_groups(judgement.edges, pair_scores, kMostFalse);
  }

  const WeightedGraph& graph_;
  const AnnealedHeatOptions& options_;
  std::vector<VertexPair> pairs_;
  int horizon_;
};

/// Whether `other` finds so many more false edges that chance does not explain it: those had
/// vouched for each other.
bool explains_more(const Judgement& other, const Judgement& than) {
  constexpr double kDeviations = 5.0;
  const double count = other.groups.false_count;
  return count - than.groups.false_count > kDeviations * std::sqrt(count);
}

/// Judges the edges of a graph without bridges and chains.
AnnealedHeat anneal_reduced(const WeightedGraph& graph, std::span<const double> lengths,
                            const AnnealedHeatOptions& options) {
  const Rounds rounds(graph, options);
  const auto first = rounds.first();
  auto judgement = rounds.trusting(first);
  const auto walks = rounds.walks(options.rounds - 1, judgement.groups.truth);
  AnnealedHeat result;
  result.scale = walks.scale;
  result.horizon = walks.horizon;
  result.scores = judgement.edges;
  judge_in_plane(graph, lengths, rounds.pairs(), walks, result);
  double chance = result.in_plane ? std::min(options.chance, kEven) : options.chance;
  if (!result.in_plane) {
    auto other = options.rounds > 2 ? rounds.doubting(first) : judgement;
    if (explains_more(other, judgement)) {
      judgement = std::move(other);
      chance = std::min(chance, kEven);
    }
    result.scores = std::move(judgement.edges);
    result.false_count = judgement.groups.false_count;
    result.truth = std::move(judgement.groups.truth);
  }
  share_among_chains(lengths, result);
  result.threshold = rejection_threshold(result.scores, {result.truth, result.false_count}, chance);
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
  }
  return result;
}

}  // namespace isotherm::spectral::detail
