#include "edges/edge_scores.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/heat/heat_affinity.hpp"
#include "isotherm/spectral/resistance/effective_resistance.hpp"

namespace isotherm::spectral {
namespace {

using detail::EdgeScores;
using detail::kUnknownScore;

// Ascending, each once, without the vertex itself.
std::vector<Index> sorted_neighbours(const WeightedGraph& graph, Index vertex) {
  std::vector<Index> found;
  for (const auto& neighbour : graph.neighbours(vertex)) {
    if (neighbour.vertex != vertex) found.push_back(neighbour.vertex);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

struct NeighbourCounts {
  std::size_t common = 0;
  std::size_t all = 0;
};

// Of two ends, which do not count themselves. The shorter list is looked up in the longer one,
// so that a hub costs little more than its neighbours.
NeighbourCounts count_neighbours(const std::vector<Index>& first, const std::vector<Index>& second,
                                 bool joined) {
  const bool swapped = second.size() < first.size();
  const auto& shorter = swapped ? second : first;
  const auto& longer = swapped ? first : second;
  const auto common = static_cast<std::size_t>(std::ranges::count_if(
      shorter, [&](Index vertex) { return std::ranges::binary_search(longer, vertex); }));
  const std::size_t ends = joined ? 2 : 0;  // each is in the other's list
  return {common, first.size() + second.size() - ends - common};
}

double jaccard_index(const NeighbourCounts& counts) {
  if (counts.all == 0) return -1.0;
  return static_cast<double>(counts.common) / static_cast<double>(counts.all);
}

double neighbour_score(const NeighbourCounts& counts, EdgeScore method) {
  if (counts.all == 0) return kUnknownScore;
  if (method == EdgeScore::jaccard) return 1.0 - jaccard_index(counts);
  return 1.0 / (1.0 + static_cast<double>(counts.common));
}

EdgeScores neighbour_scores(const WeightedGraph& graph, EdgeScore method) {
  std::vector<std::vector<Index>> neighbours;
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    neighbours.push_back(sorted_neighbours(graph, v));
  }
  EdgeScores scores;
  for (const auto& [from, to, weight] : graph.edges()) {
    const bool joined = from != to;
    scores.scores.push_back(
        neighbour_score(count_neighbours(neighbours[from], neighbours[to], joined), method));
  }
  return scores;
}

std::vector<double> affinity_scores(const std::vector<CertifiedValue>& affinities) {
  // Of an affinity that the tolerance cannot tell from 0, the upper bound is known.
  constexpr double kNoise = 4.0;
  std::vector<double> scores;
  for (const auto& affinity : affinities) {
    const bool measurable = affinity.value > kNoise * affinity.width();
    scores.push_back(1.0 / (measurable ? affinity.value : affinity.upper));
  }
  return scores;
}

EdgeScores affinity_scores(const WeightedGraph& graph, const JudgeEdgesOptions& options,
                           const RunContext& run) {
  std::vector<Index> edges(graph.edges().size());
  std::iota(edges.begin(), edges.end(), 0);
  const auto affinities = leave_one_out_affinities(
      graph, edges, std::vector{options.scale},
      {.tolerance = options.tolerance, .threads = run.threads, .progress = run.progress});
  EdgeScores scores{affinity_scores(affinities.values), {}};
  if (affinities.imprecise > 0) {
    scores.warnings.push_back(
        words_of_imprecise(affinities.imprecise, graph.edge_count(), "heat affinities"));
  }
  return scores;
}

std::string words_without_bound(const ResistanceResult& resistances) {
  char residual[32];
  std::snprintf(residual, sizeof residual, "%.1e", resistances.residual);
  return std::string(
             "effective resistances have no proven bound here, because the graph is too "
             "large for exact eliminations or its weights span more than 200 decades; "
             "largest residual ") +
         residual;
}

/// What two vertices' own edges add to any resistance between them, if no edge joins the two: with
/// all other vertices in one, nothing else is left. In dense neighbourhoods it is nearly all (von
/// Luxburg, Radl and Hein 2010).
double resistance_of_ends(double first_degree, double second_degree) {
  return 1.0 / first_degree + 1.0 / second_degree;
}

/// What is not known of resistances to a millionth of them; nothing if all is.
std::vector<std::string> doubts(const ResistanceResult& resistances, Index edge_count) {
  constexpr double kPrecise = 1e-6;
  if (!std::isfinite(resistances.bound)) return {words_without_bound(resistances)};
  if (resistances.bound <= kPrecise) return {};
  return {words_of_imprecise(edge_count, edge_count, "effective resistances")};
}

EdgeScores resistance_scores(const WeightedGraph& graph) {
  EdgeScores scores;
  const auto resistances = edge_resistances(graph);
  scores.warnings = doubts(resistances, graph.edge_count());
  const auto degrees = weighted_degrees(graph);
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto& [from, to, weight] = graph.edge(e);
    const double all = resistances.without[e];
    const double ends = resistance_of_ends(degrees[from] - weight, degrees[to] - weight);
    scores.scores.push_back(std::isfinite(all) ? std::max(0.0, all - ends) : all);
  }
  return scores;
}

}  // namespace

double jaccard_index(const WeightedGraph& graph, Index edge) {
  const auto [from, to, weight] = graph.edge(edge);
  return jaccard_index(
      count_neighbours(sorted_neighbours(graph, from), sorted_neighbours(graph, to), from != to));
}

namespace detail {

EdgeScores score_edges(const WeightedGraph& graph, const JudgeEdgesOptions& options,
                       const RunContext& run) {
  switch (options.method) {
    case EdgeScore::heat:
    case EdgeScore::heat_multiscale:
    case EdgeScore::rank:
      break;
    case EdgeScore::affinity:
      return affinity_scores(graph, options, run);
    case EdgeScore::resistance:
      return resistance_scores(graph);
    case EdgeScore::jaccard:
    case EdgeScore::common_neighbours:
      return neighbour_scores(graph, options.method);
  }
  throw InvalidArgument("method", "has no score of its own");
}

}  // namespace detail
}  // namespace isotherm::spectral
