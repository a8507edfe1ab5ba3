#include "edges/planar/likely_part.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isotherm::spectral::detail {
namespace {

/// log (1 + exp(x)), without overflow.
double log_of_one_more(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }

double least_positive(const std::vector<double>& affinities) {
  double least = 1.0;
  for (const double affinity : affinities) {
    if (affinity > 0.0) least = std::min(least, affinity);
  }
  return least;
}

std::vector<double> distances_of(const std::vector<double>& affinities, double least) {
  std::vector<double> distances;
  for (const double affinity : affinities) {
    distances.push_back(-std::log(std::max(affinity, least)));
  }
  return distances;
}

PlanarSubgraph draw_likely(const WeightedGraph& graph, std::span<const double> log_odds,
                           const PlanarSubgraphOptions& search) {
  std::vector<double> worth, suspicion;
  for (const double odds : log_odds) {
    worth.push_back(log_of_one_more(odds));
    suspicion.push_back(-odds);
  }
  return find_planar_subgraph(graph, worth, suspicion, search);
}

EdgeOdds odds_within(const WeightedGraph& graph, const std::vector<bool>& chosen,
                     std::span<const VertexPair> pairs, const WalkAffinityOptions& options) {
  std::vector<double> truth(chosen.begin(), chosen.end());
  const std::vector<Measured> measured = {distances_within(graph, chosen, pairs, options)};
  const auto features = pair_features(
      graph, {truth, truth}, pairs, measured,
      {.most_steps = options.horizon, .threads = options.threads, .progress = options.progress});
  return edge_odds(features, std::move(truth));
}

}  // namespace

std::vector<double> log_odds_of_true(std::span<const double> scores, double false_count) {
  constexpr double kLeast = 0.5;  // less than an edge is none
  const double some = std::max(kLeast, false_count);
  const double rest = std::max(kLeast, static_cast<double>(scores.size()) - some);
  const double prior = std::log(some / rest);
  std::vector<double> odds;
  for (const double score : scores) odds.push_back(-(score + prior));
  return odds;
}

double evidence_of_part(const EdgeOdds& odds, const std::vector<bool>& chosen) {
  const auto log_odds = log_odds_of_true(odds.scores, odds.false_count);
  double evidence = odds.log_evidence;
  for (std::size_t e = 0; e < chosen.size(); ++e) {
    if (!chosen[e]) evidence -= log_of_one_more(log_odds[e]);
  }
  return evidence;
}

Measured distances_within(const WeightedGraph& graph, const std::vector<bool>& chosen,
                          std::span<const VertexPair> pairs, const WalkAffinityOptions& options) {
  const std::vector<double> trust(chosen.begin(), chosen.end());
  const auto affinities = walk_affinities(graph, trust, pairs, options);
  // Ends that no walk joins are as far as any that one does.
  const double least = std::min(least_positive(affinities.edges), least_positive(affinities.pairs));
  return {distances_of(affinities.edges, least), distances_of(affinities.pairs, least)};
}

PlanarSubgraph likely_planar_part(const WeightedGraph& graph, std::span<const double> log_odds,
                                  std::span<const VertexPair> pairs,
                                  const WalkAffinityOptions& options) {
  constexpr double kFirst = 0.7;   // of the budget, for the first start
  constexpr double kLittle = 0.1;  // nats: to force such an edge in costs time for nothing
  PlanarSubgraphOptions search = {.least_forced = kLittle, .progress = options.progress};
  const double all = search.budget;
  search.budget = kFirst * all;
  auto best = draw_likely(graph, log_odds, search);
  if (best.chosen.empty()) return best;
  search.budget = all - best.work;
  auto odds = odds_within(graph, best.chosen, pairs, options);
  double evidence = evidence_of_part(odds, best.chosen);
  while (search.budget > 0.0) {
    auto other = draw_likely(graph, log_odds_of_true(odds.scores, odds.false_count), search);
    search.budget -= other.work;
    if (other.chosen.empty()) break;
    odds = odds_within(graph, other.chosen, pairs, options);
    const double now = evidence_of_part(odds, other.chosen);
    if (now <= evidence) break;
    evidence = now;
    best = std::move(other);
  }
  return best;
}

}  // namespace isotherm::spectral::detail
