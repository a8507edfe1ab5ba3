#include "edges/annealed_heat.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>

#include "edges/control_pairs.hpp"
#include "edges/odds/edge_odds.hpp"
#include "edges/odds/pair_features.hpp"
#include "edges/odds/step_counter.hpp"
#include "edges/odds/two_groups.hpp"
#include "edges/planar/likely_part.hpp"
#include "edges/planar/planar_subgraph.hpp"
#include "edges/planar/plane_features.hpp"
#include "edges/space/space_features.hpp"
#include "edges/thin_out.hpp"
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
constexpr double kEven = 0.5;             // more likely true than false
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
  double log_evidence = 0.0;
};

/// What may be known of where edges and pairs lie.
struct Layout {
  std::optional<PlaneFeatures> plane;
  std::optional<Measured> space;
};

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
    judge(0, std::vector<double>(graph_.edges().size(), 1.0), judgement);
    return judgement;
  }

  /// The rounds after the first: edges are weighted by the judgement before.
  Judgement trusting(Judgement judgement) const {
    for (int round = 1; round < options_.rounds; ++round) {
      judge(round, trust_of(judgement.groups.truth, options_.chance), judgement);
    }
    return judgement;
  }

  /// The same, but the most suspicious edges vouch for none in the second round, whatever is
  /// thought of them.
  Judgement doubting(Judgement judgement) const {
    for (int round = 1; round < options_.rounds; ++round) {
      auto trust = trust_of(judgement.groups.truth, options_.chance);
      if (round == 1) leave_out_suspicious(judgement.edges, trust);
      forget(judgement);
      judge(round, trust, judgement);
    }
    return judgement;
  }

  /// What crossings tell, if the graph is nearly planar. The drawing begins with what all else
  /// says, after a few rounds: most of what is left to settle are edges that crossings tell better.
  Layout drawn(const Judgement& heat, const WalkAffinityOptions& walks) const {
    constexpr double kFewRounds = 3.0;
    if (!has_few_enough_edges(graph_)) return {};
    const auto guess = weigh(heat, {}, kFewRounds);
    const auto log_odds = log_odds_of_true(guess.edges, guess.groups.false_count);
    return {plane_features(graph_, log_odds, thin_out(pairs_), walks), {}};
  }

  /// Weighs all that is measured in the graph that trusts what is more likely true than false, and
  /// again in the graph that this leaves, until probabilities settle.
  Judgement weigh(Judgement heat, const Layout& layout, double rounds_at_most = 10.0) const {
    constexpr double kMostEdges = 1e6;  // over all rounds: large graphs settle by their size
    const double affordable = kMostEdges / std::max(1.0, static_cast<double>(graph_.edge_count()));
    const int most_rounds = static_cast<int>(std::clamp(affordable, 1.0, rounds_at_most));
    heat.pairs = thin_out(heat.pairs);
    // To begin with, what crosses others vouches for none, and what crosses none is true.
    if (layout.plane) {
      std::ranges::transform(layout.plane->crossings.edges, heat.groups.truth.begin(),
                             [](double crossed) { return crossed > 0.0 ? 0.0 : 1.0; });
    }
    auto judgement = odds(heat, layout);
    for (int round = 0; round < most_rounds; ++round) {
      const auto trust = vouching(judgement.groups.truth);
      const auto affinities =
          walk_affinities(graph_, trust, thin_out(pairs_), walks(options_.rounds - 1, trust));
      forget(heat);
      update_scores(affinities.edges, heat.edges);
      update_scores(affinities.pairs, heat.pairs);
      heat.groups = judgement.groups;
      judgement = odds(heat, layout);
      if (have_settled(heat.groups, judgement.groups)) break;
    }
    if (!layout.plane) doubt_the_farthest(heat, judgement);
    return judgement;
  }

  /// Weighs, too, how far from each other places put the ends, if the graph is small enough and the
  /// answer leaves something to tell: more than half an edge expected to be wrong. Places are those
  /// of the edges that the answer so far believes, in two and in three dimensions; of all answers
  /// that of the highest evidence is taken.
  Judgement weigh_places(Judgement heat, Judgement answer, std::span<const double> lengths) const {
    constexpr double kHalfAnEdge = 0.5;
    if (expected_errors(answer.groups.truth) <= kHalfAnEdge) return answer;
    heat.groups = answer.groups;
    const auto trust = trust_of(answer.groups.truth, kEven);
    const FirstGuess guess{trust, answer.groups.false_count};
    for (auto& space : space_features(graph_, lengths, guess, thin_out(pairs_),
                                      {options_.seed, options_.threads, options_.progress})) {
      auto other = weigh(heat, {{}, std::move(space)});
      if (other.log_evidence > answer.log_evidence) answer = std::move(other);
    }
    return answer;
  }

 private:
  /// Odds level off where hardly any edge is true. What lies farther is counted instead: an edge is
  /// false where heat alone, against the pairs, leaves no doubt of it.
  static void doubt_the_farthest(const Judgement& heat, Judgement& judgement) {
    constexpr double kDoubt = 0.05;
    const auto by_heat = separate_groups(heat.edges, heat.pairs, kMostFalse).truth;
    auto& [truth, false_count] = judgement.groups;
    const auto count = static_cast<double>(truth.size());
    // So many edges tell a probability no better (Laplace's rule of succession).
    const double least = 1.0 / (count + 2.0);
    const double prior = std::log(false_count / (count - false_count));
    for (std::size_t k = 0; k < truth.size(); ++k) {
      if (by_heat[k] >= std::min(kDoubt, truth[k])) continue;
      truth[k] = std::min(truth[k], std::max(by_heat[k], least));
      judgement.edges[k] = std::max(judgement.edges[k], std::log(1.0 / truth[k] - 1.0) - prior);
    }
    double expected = 0.0;
    for (const double p : truth) expected += 1.0 - p;
    false_count = std::max(false_count, expected);
  }

  /// How many edges are expected to be other than what is more likely.
  static double expected_errors(std::span<const double> truth) {
    double errors = 0.0;
    for (const double p : truth) errors += std::min(p, 1.0 - p);
    return errors;
  }

  /// Whether no more than one false edge in a hundred, or half an edge, changed its place.
  static bool have_settled(const TwoGroups& before, const TwoGroups& after) {
    constexpr double kShare = 0.01;
    double change = 0.0;
    for (std::size_t k = 0; k < after.truth.size(); ++k) {
      change += std::abs(after.truth[k] - before.truth[k]);
    }
    return change <= std::max(0.5, kShare * after.false_count);
  }

  /// From a judgement by heat. Edges whose ends no walk joins vouch for none, unless crossings
  /// tell which of them are true.
  Judgement odds(const Judgement& heat, const Layout& layout) const {
    const auto& [plane, space] = layout;
    auto truth = heat.groups.truth;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      if (!plane && heat.edges[k] >= kNoWalk) truth[k] = 0.0;
    }
    std::vector<Measured> measured = {
        {within_reach(heat.edges, heat), within_reach(heat.pairs, heat)}};
    level_off(measured.front());
    if (plane) {
      measured.insert(measured.end(), {plane->crossings, plane->few_crossings, plane->distances});
    }
    if (space) measured.push_back(*space);
    // As far as walks go.
    const auto trust = vouching(truth);
    const auto features = pair_features(graph_, {truth, trust}, thin_out(pairs_), measured,
                                        {.most_steps = walks(options_.rounds - 1, trust).horizon,
                                         .threads = options_.threads,
                                         .progress = options_.progress});
    auto found = edge_odds(features, std::move(truth));
    return {std::move(found.scores),
            {},
            {std::move(found.truth), found.false_count},
            found.log_evidence};
  }

  static void forget(Judgement& judgement) {
    std::fill(judgement.edges.begin(), judgement.edges.end(), 0.0);
    std::fill(judgement.pairs.begin(), judgement.pairs.end(), 0.0);
  }

  static std::vector<double> trust_of(std::vector<double> trust, double chance) {
    for (double& p : trust) {
      if (p < chance) p = 0.0;
    }
    return trust;
  }

  /// The trust of edges that are more likely true than false. A vertex all of whose edges are
  /// likely false keeps them: one of them should be true, or it would not be there.
  std::vector<double> vouching(const std::vector<double>& truth) const {
    auto trust = trust_of(truth, kEven);
    std::vector<bool> joined(graph_.vertex_count(), false);
    for (Index e = 0; e < graph_.edge_count(); ++e) {
      if (trust[e] > 0.0) joined[graph_.edge(e).from] = joined[graph_.edge(e).to] = true;
    }
    for (Index e = 0; e < graph_.edge_count(); ++e) {
      if (!joined[graph_.edge(e).from] || !joined[graph_.edge(e).to]) trust[e] = 1.0;
    }
    return trust;
  }

  void judge(int round, const std::vector<double>& trust, Judgement& judgement) const {
    const auto affinities = walk_affinities(graph_, trust, pairs_, walks(round, trust));
    update_scores(affinities.edges, judgement.edges);
    update_scores(affinities.pairs, judgement.pairs);
    judgement.groups = separate_groups(judgement.edges, judgement.pairs, kMostFalse);
  }

  /// Ends that no walk joins keep the order of the round before.
  static void update_scores(const std::vector<double>& affinities, std::vector<double>& scores) {
    for (std::size_t k = 0; k < scores.size(); ++k) {
      scores[k] = affinities[k] > 0.0 ? -std::log(affinities[k]) : kNoWalk + scores[k];
    }
  }

  /// Scores, of which those of ends that no walk joins are the largest of the others.
  static std::vector<double> within_reach(std::vector<double> scores, const Judgement& all) {
    double largest = 0.0;
    for (const auto& list : {std::cref(all.edges), std::cref(all.pairs)}) {
      for (const double score : list.get()) {
        if (score < kNoWalk) largest = std::max(largest, score);
      }
    }
    for (double& score : scores) score = std::min(score, largest);
    return scores;
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

  const WeightedGraph& graph_;
  const AnnealedHeatOptions& options_;
  std::vector<VertexPair> pairs_;
  int horizon_;
};

/// Judges the edges of a graph without bridges and chains.
AnnealedHeat anneal_reduced(const WeightedGraph& graph, std::span<const double> lengths,
                            const AnnealedHeatOptions& options) {
  if (graph.edge_count() == 0) return {};
  const Rounds rounds(graph, options);
  const auto first = rounds.first();
  auto heat = rounds.trusting(first);
  const auto walks = rounds.walks(options.rounds - 1, heat.groups.truth);
  const auto layout = rounds.drawn(heat, walks);
  const bool in_plane = layout.plane.has_value();
  auto judgement = rounds.weigh(heat, layout);
  if (!in_plane && options.rounds > 2) {
    auto doubting = rounds.doubting(first);
    auto other = rounds.weigh(doubting, {});
    if (other.log_evidence > judgement.log_evidence) {
      judgement = std::move(other);
      heat = std::move(doubting);
    }
  }
  if (!in_plane && options.places) {
    judgement = rounds.weigh_places(std::move(heat), std::move(judgement), lengths);
  }
  AnnealedHeat result;
  result.scale = walks.scale;
  result.horizon = walks.horizon;
  result.in_plane = in_plane;
  result.scores = std::move(judgement.edges);
  result.false_count = judgement.groups.false_count;
  result.truth = std::move(judgement.groups.truth);
  share_among_chains(lengths, result);
  // From 0 on, which is the score of what is not judged.
  const double least = std::ranges::min(result.scores);
  for (double& score : result.scores) score -= least;
  // Shortcuts that run side by side vouch for each other, and many of their neighbours are doubted.
  const double chance = in_plane ? std::min(options.chance, kEven) : options.chance;
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
