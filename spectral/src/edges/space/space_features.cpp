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
constexpr Eigen::Index kMostDimensions = 3;

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
/// Two are needed to see two ends that a vertex may hang on.
int affordable_runs(Index vertex_count) {
  constexpr double kPairBudget = 2e8;  // pairs that are looked at
  constexpr double kFewestRuns = 2.0, kMostRuns = 4.0;
  constexpr Index kMostVertices = 1400;
  if (vertex_count > kMostVertices) return 0;
  const auto count = static_cast<double>(vertex_count);
  const double runs = kPairBudget / (0.5 * count * count * sampling_steps());
  return static_cast<int>(std::clamp(runs, kFewestRuns, kMostRuns));
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

/// Vertices all of whose edges are doubted.
std::vector<Index> doubted_vertices(const WeightedGraph& graph, std::span<const double> trust) {
  std::vector<Index> doubted;
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    const auto trusted = [&](const auto& near) { return trust[near.edge] > 0.0; };
    if (std::ranges::none_of(graph.neighbours(v), trusted)) doubted.push_back(v);
  }
  return doubted;
}

/// Places in three dimensions, in steps, to start runs from, which take turns. A vertex all of
/// whose edges are doubted hangs on one of them, in each on another: starts are to differ in what
/// is not known (Gelman and Rubin 1992).
std::vector<Eigen::MatrixXd> run_starts(const WeightedGraph& graph, std::span<const double> lengths,
                                        std::span<const double> trust) {
  const auto doubted = doubted_vertices(graph, trust);
  const std::size_t count = doubted.empty() ? 1 : affordable_runs(graph.vertex_count());
  std::vector<Eigen::MatrixXd> starts;
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<double> held(trust.begin(), trust.end());
    for (const Index v : doubted) {
      const auto near = graph.neighbours(v);
      held[near[k % near.size()].edge] = 1.0;
    }
    starts.push_back(classical_scaling(steps_between(graph, lengths, held), kMostDimensions));
  }
  return starts;
}

/// That of the coordinates, but no less than an edge reaches.
template <int Dimension>
double spread_of(const Places<Dimension>& places) {
  return std::max(1.0, std::sqrt(places.squaredNorm() / static_cast<double>(places.size())));
}

/// What all runs in a space of one dimension share.
struct Runs {
  const ContactGraph& contacts;
  std::span<const Eigen::MatrixXd> starts;
  std::span<const AskedPair> asked;
  double astray;
  std::uint64_t seed;

  template <int Dimension>
  LeftOut sample(std::size_t run) const {
    // Points spread evenly over a ball are that far from its middle on average.
    constexpr double kStep = Dimension / (Dimension + 1.0);
    const Places<Dimension> start = kStep * starts[run % starts.size()].topRows<Dimension>();
    const ContactModel model{kWidth, astray, spread_of<Dimension>(start)};
    return sample_places<Dimension>(contacts, model, start, asked, seed + run);
  }
};

LeftOut sum_of(std::span<const LeftOut> runs) {
  LeftOut all = runs.front();
  for (const auto& run : runs.subspan(1)) {
    for (std::size_t p = 0; p < all.near.size(); ++p) {
      all.near[p] += run.near[p];
      all.weight[p] += run.weight[p];
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

std::vector<Measured> space_features(const WeightedGraph& graph, std::span<const double> lengths,
                                     const FirstGuess& guess, std::span<const VertexPair> pairs,
                                     const SpaceOptions& options) {
  constexpr Index kFewest = 10;
  const Occupied occupied(graph);
  const Index count = occupied.graph.vertex_count();
  const auto run_count = static_cast<std::size_t>(affordable_runs(count));
  if (count < kFewest || run_count == 0) return {};
  const ContactGraph contacts(occupied.graph, lengths);
  const auto starts = run_starts(occupied.graph, lengths, guess.trust);
  const auto asked = all_asked(occupied, lengths, pairs);
  const double pair_count = 0.5 * static_cast<double>(count) * static_cast<double>(count - 1);
  const Runs runs{contacts, starts, asked, std::max(1.0, guess.false_count) / pair_count,
                  options.seed};
  std::vector<LeftOut> sums(2 * run_count);
  parallel_for(static_cast<std::int64_t>(sums.size()), options.threads, options.progress, "places",
               [&](std::int64_t k) {
                 const auto run = static_cast<std::size_t>(k) % run_count;
                 const bool in_plane = static_cast<std::size_t>(k) < run_count;
                 sums[k] = in_plane ? runs.sample<2>(run) : runs.sample<3>(run);
               });
  const std::span<const LeftOut> all(sums);
  return {log_odds(sum_of(all.first(run_count)), graph.edges().size()),
          log_odds(sum_of(all.last(run_count)), graph.edges().size())};
}

}  // namespace isotherm::spectral::detail
