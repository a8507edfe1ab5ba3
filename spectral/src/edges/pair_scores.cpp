#include "edges/pair_scores.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

#include "edges/thin_out.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/spectral/heat/heat_affinity.hpp"
#include "isotherm/spectral/resistance/effective_resistance.hpp"
#include "isotherm/spectral/sparse/laplacian_solver.hpp"

namespace isotherm::spectral {
namespace {

using detail::kUnknownScore;
using detail::PairScores;

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

PairScores neighbour_scores(const WeightedGraph& graph, const std::vector<VertexPair>& pairs,
                            EdgeScore method) {
  std::vector<std::vector<Index>> neighbours;
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    neighbours.push_back(sorted_neighbours(graph, v));
  }
  const auto score = [&](Index from, Index to, bool joined) {
    return neighbour_score(count_neighbours(neighbours[from], neighbours[to], joined), method);
  };
  PairScores scores;
  for (const auto& [from, to, weight] : graph.edges())
    scores.edges.push_back(score(from, to, true));
  for (const auto& [from, to] : pairs) scores.pairs.push_back(score(from, to, false));
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

PairScores affinity_scores(const WeightedGraph& graph, const std::vector<VertexPair>& pairs,
                           const JudgeEdgesOptions& options, const RunContext& run) {
  std::vector<Index> edges(graph.edges().size());
  std::iota(edges.begin(), edges.end(), 0);
  const std::vector<double> scales = {options.scale};
  const HeatDistanceOptions heat = {
      .tolerance = options.tolerance, .threads = run.threads, .progress = run.progress};
  return {affinity_scores(leave_one_out_affinities(graph, edges, scales, heat).values),
          affinity_scores(heat_affinities(graph, detail::thin_out(pairs), scales, heat).values)};
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

PairScores resistance_scores(const WeightedGraph& graph, const std::vector<VertexPair>& pairs,
                             const RunContext& run) {
  constexpr std::size_t kMostSolves = 1000;
  PairScores scores;
  auto resistances = edge_resistances(graph);
  if (!std::isfinite(resistances.bound))
    scores.warnings.push_back(words_without_bound(resistances));
  const auto degrees = weighted_degrees(graph);
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto& [from, to, weight] = graph.edge(e);
    const double all = resistances.without[e];
    const double ends = resistance_of_ends(degrees[from] - weight, degrees[to] - weight);
    scores.edges.push_back(std::isfinite(all) ? std::max(0.0, all - ends) : all);
  }
  LaplacianSolver solver{Laplacian(graph)};
  const auto component = connected_components(graph).label;
  Eigen::VectorXd current = Eigen::VectorXd::Zero(graph.vertex_count());
  for (const auto& [from, to] : detail::thin_out(pairs, kMostSolves)) {
    if (component[from] != component[to]) continue;
    if (run.progress && !run.progress({"resistances", scores.pairs.size(), kMostSolves})) {
      throw Cancelled();
    }
    current[from] = 1.0;
    current[to] = -1.0;
    const Eigen::VectorXd potential = solver.solve(current);
    scores.pairs.push_back(potential[from] - potential[to] -
                           resistance_of_ends(degrees[from], degrees[to]));
    current[from] = current[to] = 0.0;
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

PairScores score_pairs(const WeightedGraph& graph, const std::vector<VertexPair>& pairs,
                       const JudgeEdgesOptions& options, const RunContext& run) {
  switch (options.method) {
    case EdgeScore::heat:
    case EdgeScore::heat_multiscale:
    case EdgeScore::rank:
      break;
    case EdgeScore::affinity:
      return affinity_scores(graph, pairs, options, run);
    case EdgeScore::resistance:
      return resistance_scores(graph, pairs, run);
    case EdgeScore::jaccard:
    case EdgeScore::common_neighbours:
      return neighbour_scores(graph, pairs, options.method);
  }
  throw InvalidArgument("method", "is not a method of pairs");
}

}  // namespace detail
}  // namespace isotherm::spectral
