#include "edges/odds/pair_features.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "edges/odds/step_counter.hpp"
#include "isotherm/base/parallel.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr Eigen::Index kOwn = 4;  // columns after those given

/// The neighbours of each vertex along trusted edges, ascending, each once, without itself.
std::vector<std::vector<Index>> trusted_neighbours(const WeightedGraph& graph,
                                                   std::span<const double> trust) {
  std::vector<std::vector<Index>> neighbours(graph.vertex_count());
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto& [from, to, weight] = graph.edge(e);
    if (trust[e] == 0.0 || from == to) continue;
    neighbours[from].push_back(to);
    neighbours[to].push_back(from);
  }
  for (auto& of_vertex : neighbours) {
    std::sort(of_vertex.begin(), of_vertex.end());
    of_vertex.erase(std::unique(of_vertex.begin(), of_vertex.end()), of_vertex.end());
  }
  return neighbours;
}

std::size_t count_common(const std::vector<Index>& first, const std::vector<Index>& second) {
  const bool swapped = second.size() < first.size();
  const auto& shorter = swapped ? second : first;
  const auto& longer = swapped ? first : second;
  return static_cast<std::size_t>(std::ranges::count_if(
      shorter, [&](Index vertex) { return std::ranges::binary_search(longer, vertex); }));
}

class Measurer {
 public:
  Measurer(const WeightedGraph& graph, std::span<const double> trust,
           const std::vector<std::vector<Index>>& neighbours, int most_steps)
      : steps_(graph, trust), neighbours_(neighbours), most_steps_(most_steps) {}

  /// Fills the last columns of a row. `edge` is left out; none is if < 0.
  template <class Row>
  void measure(VertexPair pair, Index edge, Row row) {
    constexpr double kHalf = 0.5;  // of a neighbour more: the logarithm of none is finite
    const auto& first = neighbours_[pair.from];
    const auto& second = neighbours_[pair.to];
    const bool joined = std::ranges::binary_search(first, pair.to);
    const double a = neighbours_without(first, joined), b = neighbours_without(second, joined);
    const Eigen::Index start = row.size() - kOwn;
    row[start] = steps_.count(pair, most_steps_, edge);
    row[start + 1] = std::log(static_cast<double>(count_common(first, second)) + kHalf);
    row[start + 2] = std::log(std::min(a, b));
    row[start + 3] = std::log(std::max(a, b));
  }

 private:
  static double neighbours_without(const std::vector<Index>& neighbours, bool joined) {
    constexpr double kFewest = 3.0;
    return std::max(kFewest, static_cast<double>(neighbours.size()) - (joined ? 1.0 : 0.0));
  }

  StepCounter steps_;
  const std::vector<std::vector<Index>>& neighbours_;
  int most_steps_;
};

Eigen::MatrixXd with_room(std::span<const Measured> given, std::vector<double> Measured::*of,
                          std::size_t count) {
  const auto rows = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd matrix(rows, static_cast<Eigen::Index>(given.size()) + kOwn);
  for (std::size_t c = 0; c < given.size(); ++c) {
    matrix.col(static_cast<Eigen::Index>(c)) =
        Eigen::Map<const Eigen::VectorXd>((given[c].*of).data(), rows);
  }
  return matrix;
}

}  // namespace

PairFeatures pair_features(const WeightedGraph& graph, std::span<const double> trust,
                           std::span<const VertexPair> pairs, std::span<const Measured> given,
                           const PairFeatureOptions& options) {
  const auto neighbours = trusted_neighbours(graph, trust);
  PairFeatures features{with_room(given, &Measured::edges, graph.edges().size()),
                        with_room(given, &Measured::pairs, pairs.size())};
  const auto edge_count = static_cast<std::int64_t>(graph.edge_count());
  parallel_for(
      edge_count + static_cast<std::int64_t>(pairs.size()), 256, options.threads, options.progress,
      "steps", [&] { return Measurer(graph, trust, neighbours, options.most_steps); },
      [&](Measurer& measurer, std::int64_t k) {
        if (k < edge_count) {
          const auto edge = static_cast<Index>(k);
          measurer.measure({graph.edge(edge).from, graph.edge(edge).to}, edge,
                           features.edges.row(k));
        } else {
          measurer.measure(pairs[k - edge_count], -1, features.pairs.row(k - edge_count));
        }
      });
  return features;
}

}  // namespace isotherm::spectral::detail
