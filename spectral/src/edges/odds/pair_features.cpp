#include "edges/odds/pair_features.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "edges/odds/step_counter.hpp"
#include "isotherm/base/parallel.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr Eigen::Index kOwn = 5;  // columns after those given

struct Neighbour {
  Index vertex = 0;
  double truth = 0.0;  // of the edge to it
};

/// The neighbours of each vertex, ascending, each once, without itself.
class Neighbourhoods {
 public:
  Neighbourhoods(const WeightedGraph& graph, std::span<const double> truth)
      : of_(graph.vertex_count()), sizes_(graph.vertex_count(), 0.0) {
    for (Index e = 0; e < graph.edge_count(); ++e) {
      const auto& [from, to, weight] = graph.edge(e);
      if (truth[e] == 0.0 || from == to) continue;
      of_[from].push_back({to, truth[e]});
      of_[to].push_back({from, truth[e]});
    }
    for (std::size_t v = 0; v < of_.size(); ++v) {
      // Of parallel edges the one that is most likely true.
      std::ranges::sort(of_[v], [](const Neighbour& a, const Neighbour& b) {
        return std::pair(a.vertex, -a.truth) < std::pair(b.vertex, -b.truth);
      });
      const auto same = [](const Neighbour& a, const Neighbour& b) { return a.vertex == b.vertex; };
      of_[v].erase(std::unique(of_[v].begin(), of_[v].end(), same), of_[v].end());
      for (const auto& neighbour : of_[v]) sizes_[v] += neighbour.truth;
    }
  }

  double size(Index vertex) const { return sizes_[vertex]; }

  /// Both edges to a neighbour in common must be true.
  double common(Index first, Index second) const {
    const bool swapped = of_[second].size() < of_[first].size();
    const auto& shorter = swapped ? of_[second] : of_[first];
    const Index other = swapped ? first : second;
    double count = 0.0;
    for (const auto& neighbour : shorter) count += neighbour.truth * truth(other, neighbour.vertex);
    return count;
  }

  /// Of the edge between two vertices; 0 if there is none.
  double truth(Index vertex, Index other) const {
    const auto& list = of_[vertex];
    const auto found = std::ranges::lower_bound(list, other, {}, &Neighbour::vertex);
    return found != list.end() && found->vertex == other ? found->truth : 0.0;
  }

 private:
  std::vector<std::vector<Neighbour>> of_;
  std::vector<double> sizes_;
};

class Measurer {
 public:
  Measurer(const WeightedGraph& graph, std::span<const double> trust,
           const Neighbourhoods& neighbourhoods, int most_steps)
      : steps_(graph, trust), neighbourhoods_(neighbourhoods), most_steps_(most_steps) {}

  /// Fills the last columns of a row. `edge` is left out; none is if < 0.
  template <class Row>
  void measure(VertexPair pair, Index edge, Row row) {
    constexpr double kHalf = 0.5;  // of a neighbour more: the logarithm of none is finite
    const double own = neighbourhoods_.truth(pair.from, pair.to);
    const double first = log_size(pair.from, own), second = log_size(pair.to, own);
    const double common = std::log(neighbourhoods_.common(pair.from, pair.to) + kHalf);
    const auto [fewer, more] = std::minmax({first, second});
    const Eigen::Index start = row.size() - kOwn;
    row[start] = steps_.count(pair, most_steps_, edge);
    row[start + 1] = fewer - common;
    row[start + 2] = more - common;
    row[start + 3] = fewer;
    row[start + 4] = more;
  }

 private:
  /// Of a vertex's neighbours, and one more, without the edge of the truth given.
  double log_size(Index vertex, double own) const {
    constexpr double kFewest = 3.0;
    return std::log(std::max(kFewest, neighbourhoods_.size(vertex) - own) + 1.0);
  }

  StepCounter steps_;
  const Neighbourhoods& neighbourhoods_;
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

/// The middle of the values; of an even number of them the larger of the two.
template <class Values>
double middle_of(const Values& values) {
  std::vector<double> sorted(values.begin(), values.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

void level_off_steps(PairFeatures& features) {
  if (features.pairs.rows() == 0) return;
  const Eigen::Index steps = features.pairs.cols() - kOwn;
  const double most = middle_of(features.pairs.col(steps));
  features.edges.col(steps) = features.edges.col(steps).cwiseMin(most);
  features.pairs.col(steps) = features.pairs.col(steps).cwiseMin(most);
}

}  // namespace

PairFeatures pair_features(const WeightedGraph& graph, const EdgeBelief& belief,
                           std::span<const VertexPair> pairs, std::span<const Measured> given,
                           const PairFeatureOptions& options) {
  const Neighbourhoods neighbourhoods(graph, belief.truth);
  PairFeatures features{with_room(given, &Measured::edges, graph.edges().size()),
                        with_room(given, &Measured::pairs, pairs.size())};
  const auto edge_count = static_cast<std::int64_t>(graph.edge_count());
  parallel_for(
      edge_count + static_cast<std::int64_t>(pairs.size()), 256, options.threads, options.progress,
      "steps", [&] { return Measurer(graph, belief.trust, neighbourhoods, options.most_steps); },
      [&](Measurer& measurer, std::int64_t k) {
        if (k < edge_count) {
          const auto edge = static_cast<Index>(k);
          measurer.measure({graph.edge(edge).from, graph.edge(edge).to}, edge,
                           features.edges.row(k));
        } else {
          measurer.measure(pairs[k - edge_count], -1, features.pairs.row(k - edge_count));
        }
      });
  level_off_steps(features);
  return features;
}

void level_off(Measured& measured) {
  if (measured.pairs.empty()) return;
  const double most = middle_of(measured.pairs);
  for (auto* list : {&measured.edges, &measured.pairs}) {
    for (double& value : *list) value = std::min(value, most);
  }
}

}  // namespace isotherm::spectral::detail
