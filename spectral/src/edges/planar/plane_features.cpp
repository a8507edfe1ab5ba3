#include "edges/planar/plane_features.hpp"

#include <algorithm>

#include "edges/planar/likely_part.hpp"
#include "edges/planar/plane_map.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr int kMostCrossings = 20;  // more say no more

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

std::vector<double> no_more_than(double most, const std::vector<int>& counts) {
  std::vector<double> values;
  for (const int count : counts) values.push_back(std::min<double>(most, count));
  return values;
}

}  // namespace

std::optional<PlaneFeatures> plane_features(const WeightedGraph& graph,
                                            std::span<const double> log_odds,
                                            std::span<const VertexPair> pairs,
                                            const WalkAffinityOptions& options) {
  constexpr double kFew = 3.0;
  const auto plane = likely_planar_part(graph, log_odds, pairs, options);
  if (plane.chosen.empty()) return std::nullopt;
  PlaneMap map(graph, plane.chosen);
  const auto of_pairs = crossings_of_pairs(pairs, map);
  if (!is_telling(of_pairs)) return std::nullopt;
  const auto of_edges = crossings_of_edges(graph, plane, map);
  return PlaneFeatures{
      {no_more_than(kMostCrossings, of_edges), no_more_than(kMostCrossings, of_pairs)},
      {no_more_than(kFew, of_edges), no_more_than(kFew, of_pairs)},
      distances_within(graph, plane.chosen, pairs, options)};
}

}  // namespace isotherm::spectral::detail
