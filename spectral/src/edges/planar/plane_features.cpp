#include "edges/planar/plane_features.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "edges/planar/planar_subgraph.hpp"
#include "edges/planar/plane_map.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr int kMostCrossings = 20;  // more say no more

WalkAffinities affinities_within(const WeightedGraph& graph, const PlanarSubgraph& plane,
                                 std::span<const VertexPair> pairs,
                                 const WalkAffinityOptions& options) {
  const std::vector<double> trust(plane.chosen.begin(), plane.chosen.end());
  return walk_affinities(graph, trust, pairs, options);
}

PlanarSubgraph best_subgraph(const WeightedGraph& graph, std::span<const double> lengths,
                             std::span<const double> suspicion,
                             const WalkAffinityOptions& options) {
  constexpr int kMoreStarts = 2;
  constexpr double kFirst = 0.7;  // of the budget, for the first start
  PlanarSubgraphOptions search = {.progress = options.progress};
  const double all = search.budget;
  search.budget = kFirst * all;
  auto best = find_planar_subgraph(graph, lengths, suspicion, search);
  search.budget = all - best.work;
  for (int start = 0; start < kMoreStarts && !best.chosen.empty(); ++start) {
    const auto affinities = affinities_within(graph, best, {}, options).edges;
    std::vector<double> within;
    for (const double affinity : affinities) {
      within.push_back(-std::log(std::max(affinity, std::numeric_limits<double>::min())));
    }
    auto other = find_planar_subgraph(graph, lengths, within, search);
    search.budget -= other.work;
    if (other.worth <= best.worth) break;
    best = std::move(other);
  }
  return best;
}

double least_positive(const std::vector<double>& affinities) {
  double least = 1.0;
  for (const double affinity : affinities) {
    if (affinity > 0.0) least = std::min(least, affinity);
  }
  return least;
}

std::vector<int> crossings_of_edges(const WeightedGraph& graph, const PlanarSubgraph& plane,
                                    PlaneMap& map) {
  std::vector<int> crossings;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto& [from, to, weight] = graph.edge(e);
    // What could be added by itself may still not fit in another drawing.
    crossings.push_back(plane.chosen[e] ? 0 : std::max(1, map.crossings(from, to, kMostCrossings)));
  }
  return crossings;
}

std::vector<int> crossings_of_pairs(std::span<const VertexPair> pairs, PlaneMap& map) {
  std::vector<int> crossings;
  for (const auto& [from, to] : pairs) crossings.push_back(map.crossings(from, to, kMostCrossings));
  return crossings;
}

/// Whether most of what is false would show.
bool is_telling(const std::vector<int>& crossings_of_pairs) {
  constexpr double kMostHidden = 0.2;
  const auto hidden = std::count(crossings_of_pairs.begin(), crossings_of_pairs.end(), 0);
  return static_cast<double>(hidden) < kMostHidden * static_cast<double>(crossings_of_pairs.size());
}

std::vector<double> distances_of(const std::vector<double>& affinities, double least) {
  std::vector<double> distances;
  for (const double affinity : affinities) {
    distances.push_back(-std::log(std::max(affinity, least)));
  }
  return distances;
}

std::vector<double> no_more_than(double most, const std::vector<int>& counts) {
  std::vector<double> values;
  for (const int count : counts) values.push_back(std::min<double>(most, count));
  return values;
}

}  // namespace

std::optional<PlaneFeatures> plane_features(const WeightedGraph& graph,
                                            std::span<const double> lengths,
                                            std::span<const double> suspicion,
                                            std::span<const VertexPair> pairs,
                                            const WalkAffinityOptions& options) {
  constexpr double kFew = 3.0;
  const auto plane = best_subgraph(graph, lengths, suspicion, options);
  if (plane.chosen.empty()) return std::nullopt;
  PlaneMap map(graph, plane.chosen);
  const auto of_pairs = crossings_of_pairs(pairs, map);
  if (!is_telling(of_pairs)) return std::nullopt;
  const auto of_edges = crossings_of_edges(graph, plane, map);
  const auto affinities = affinities_within(graph, plane, pairs, options);
  // Ends that no walk joins are as far as any that one does.
  const double least = std::min(least_positive(affinities.edges), least_positive(affinities.pairs));
  return PlaneFeatures{
      {no_more_than(kMostCrossings, of_edges), no_more_than(kMostCrossings, of_pairs)},
      {no_more_than(kFew, of_edges), no_more_than(kFew, of_pairs)},
      {distances_of(affinities.edges, least), distances_of(affinities.pairs, least)}};
}

}  // namespace isotherm::spectral::detail
