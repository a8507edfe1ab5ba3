#include "edges/space/space_features.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "edges/space/classical_scaling.hpp"
#include "edges/space/place_sampler.hpp"
#include "isotherm/base/parallel.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr double kWidth = 0.03;  // narrower, and samples hardly move

/// The vertices with an edge, by themselves.
struct Occupied {
  WeightedGraph graph;
  std::vector<Index> ids;  // by vertex of the whole graph

  explicit Occupied(const WeightedGraph& whole) : ids(whole.vertex_count(), -1) {
    Index count = 0;
    for (Index v = 0; v < whole.vertex_count(); ++v) {
      if (!whole.neighbours(v).empty()) ids[v] = count++;
    }
    std::vector<WeightedEdge> edges;
    for (const auto& [from, to, weight] : whole.edges()) {
      edges.push_back({ids[from], ids[to], weight});
    }
    graph = WeightedGraph(count, edges);
  }
};

/// The more vertices, the more each place is held by others, and the less one run tells than many.
int affordable_runs(Index vertex_count) {
  constexpr double kBudget = 2e8;  // pairs that are looked at
  constexpr double kMostRuns = 8.0;
  constexpr Index kMostVertices = 1400;
  if (vertex_count > kMostVertices) return 0;
  const auto count = static_cast<double>(vertex_count);
  const double runs = kBudget / (0.5 * count * count * sampling_steps());
  return static_cast<int>(std::clamp(runs, 1.0, kMostRuns));
}

std::vector<AskedPair> all_asked(const Occupied& occupied, std::span<const double> lengths,
                                 std::span<const VertexPair> pairs) {
  std::vector<AskedPair> asked;
  for (Index e = 0; e < occupied.graph.edge_count(); ++e) {
    const auto& [from, to, weight] = occupied.graph.edge(e);
    asked.push_back({{from, to}, lengths[e], true});
  }
  for (const auto& [from, to] : pairs) {
    asked.push_back({{occupied.ids[from], occupied.ids[to]}, 1.0, false});
  }
  return asked;
}

template <int Dimension>
LeftOut sample_often(const Occupied& occupied, std::span<const double> lengths,
                     const FirstGuess& guess, std::span<const AskedPair> asked,
                     const SpaceOptions& options) {
  // Points spread evenly over a ball are that far from its middle on average.
  constexpr double kStep = Dimension / (Dimension + 1.0);
  const Index count = occupied.graph.vertex_count();
  const ContactGraph contacts(occupied.graph, lengths);
  const double pair_count = 0.5 * static_cast<double>(count) * static_cast<double>(count - 1);
  const ContactModel model{kWidth, std::max(1.0, guess.false_count) / pair_count};
  const Places<Dimension> start =
      kStep * classical_scaling(steps_between(occupied.graph, lengths, guess.trust), Dimension);
  std::vector<LeftOut> runs(affordable_runs(count));
  parallel_for(static_cast<std::int64_t>(runs.size()), options.threads, options.progress, "places",
               [&](std::int64_t k) {
                 const auto seed = options.seed + static_cast<std::uint64_t>(k);
                 runs[k] = sample_places<Dimension>(contacts, model, start, asked, seed);
               });
  LeftOut all = std::move(runs.front());
  for (std::size_t k = 1; k < runs.size(); ++k) {
    for (std::size_t p = 0; p < asked.size(); ++p) {
      all.near[p] += runs[k].near[p];
      all.weight[p] += runs[k].weight[p];
    }
  }
  return all;
}

Measured log_odds(const LeftOut& sums, std::size_t edge_count) {
  constexpr double kLeast = 1e-6;  // of a probability that samples tell
  Measured far;
  for (std::size_t k = 0; k < sums.near.size(); ++k) {
    const double near = std::clamp(sums.near[k] / sums.weight[k], kLeast, 1.0 - kLeast);
    (k < edge_count ? far.edges : far.pairs).push_back(std::log(1.0 / near - 1.0));
  }
  return far;
}

}  // namespace

std::optional<Measured> space_features(const WeightedGraph& graph, std::span<const double> lengths,
                                       int dimension, const FirstGuess& guess,
                                       std::span<const VertexPair> pairs,
                                       const SpaceOptions& options) {
  constexpr Index kFewest = 10;
  const Occupied occupied(graph);
  const Index count = occupied.graph.vertex_count();
  if (count < kFewest || affordable_runs(count) == 0) return std::nullopt;
  const auto asked = all_asked(occupied, lengths, pairs);
  const auto sums = dimension == 2 ? sample_often<2>(occupied, lengths, guess, asked, options)
                                   : sample_often<3>(occupied, lengths, guess, asked, options);
  return log_odds(sums, graph.edges().size());
}

}  // namespace isotherm::spectral::detail
