#include "isotherm/spectral/resistance/effective_resistance.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

#include <Eigen/SparseCore>

#include "graph/simple_graph.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"
#include "resistance/kron_conductance.hpp"
#include "sparse/inverse/selected_inverse.hpp"
#include "sparse/laplacian/grounded_laplacian.hpp"
#include "sparse/pair_pattern.hpp"

namespace isotherm::spectral {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr double kMostOperations = 2e10;
constexpr double kMostNumbers = 5e7;  // that fronts say to each other
constexpr double kMostDecades = 200.0;

/// Edges of a simple graph, and pairs that no edge of it joins; weights relative to the largest.
class Connections {
 public:
  Connections(const WeightedGraph& graph, std::span<const VertexPair> pairs,
              const std::vector<Index>& component)
      : simple_(detail::merge_parallel_edges(graph)) {
    for (const auto& edge : simple_.graph.edges()) {
      pairs_.push_back(ordered({edge.from, edge.to}));
      largest_ = std::max(largest_, edge.weight);
      least_ = std::min(least_, edge.weight);
    }
    for (std::size_t k = 0; k < pairs_.size(); ++k) place_[key(pairs_[k])] = k;
    for (const auto& pair : pairs) {
      const bool nothing = pair.from == pair.to || component[pair.from] != component[pair.to];
      of_query_.push_back(nothing ? kNoPlace : place_of(ordered(pair)));
    }
  }

  static constexpr std::size_t kNoPlace = static_cast<std::size_t>(-1);

  std::span<const VertexPair> pairs() const { return pairs_; }
  std::size_t of_query(std::size_t query) const { return of_query_[query]; }
  double largest() const { return largest_; }
  bool within_range() const { return std::log10(largest_) - std::log10(least_) < kMostDecades; }

  /// Conductance of the edge that joins a pair, relative to the largest; 0 without one.
  double direct(std::size_t place) const {
    const auto edges = simple_.graph.edges();
    return place < edges.size() ? edges[place].weight / largest_ : 0.0;
  }

 private:
  static VertexPair ordered(VertexPair pair) {
    return {std::min(pair.from, pair.to), std::max(pair.from, pair.to)};
  }
  static std::uint64_t key(VertexPair pair) {
    return static_cast<std::uint64_t>(pair.from) << 32 | static_cast<std::uint32_t>(pair.to);
  }
  std::size_t place_of(VertexPair pair) {
    const auto [found, is_new] = place_.try_emplace(key(pair), pairs_.size());
    if (is_new) pairs_.push_back(pair);
    return found->second;
  }

  detail::SimpleGraph simple_;
  std::vector<VertexPair> pairs_;
  std::unordered_map<std::uint64_t, std::size_t> place_;
  std::vector<std::size_t> of_query_;
  double largest_ = 0.0;
  double least_ = std::numeric_limits<double>::max();
};

bool affordable(const detail::FrontTree& tree) {
  double operations = 0.0, numbers = 0.0;
  for (Index s = 0; s < tree.front_count(); ++s) {
    const double size = tree.size(s), shared = size - tree.width(s);
    operations += size * size * size;
    numbers += shared * shared;
  }
  return operations < kMostOperations && numbers < kMostNumbers;
}

std::vector<std::vector<detail::PairOfFront>> by_front(const detail::FrontTree& tree,
                                                       const Connections& connections) {
  const auto located = detail::locate(tree, connections.pairs());
  std::vector<std::vector<detail::PairOfFront>> pairs(tree.front_count());
  for (Index s = 0; s < tree.front_count(); ++s) {
    for (Index q = located.start[s]; q < located.start[s + 1]; ++q) {
      const auto& query = located.queries[q];
      pairs[s].push_back({query.pair, std::min(query.first, query.second),
                          std::max(query.first, query.second),
                          connections.direct(static_cast<std::size_t>(query.pair))});
    }
  }
  return pairs;
}

/// By eliminations without subtraction; false if that is not affordable.
bool resist_by_elimination(const Laplacian& laplacian, const Connections& connections,
                           ResistanceResult& result) {
  const SparseMatrix lower = laplacian.matrix().triangularView<Eigen::Lower>();
  const auto matrix = detail::analyse(detail::with_pairs(lower, connections.pairs()));
  if (!affordable(matrix.tree)) return false;
  const auto rest = detail::rest_conductances(matrix.tree, by_front(matrix.tree, connections),
                                              connections.pairs().size());
  for (std::size_t k = 0; k < result.values.size(); ++k) {
    const std::size_t place = connections.of_query(k);
    if (place == Connections::kNoPlace) continue;
    result.values[k] = 1.0 / (rest[place] + connections.direct(place)) / connections.largest();
    result.without[k] = 1.0 / rest[place] / connections.largest();
  }
  result.bound = connections.within_range()
                     ? detail::kron_rounding(matrix.tree, connections.pairs().size())
                     : kInfinity;
  return true;
}

/// By one factorisation and selected inversion.
void resist_by_inversion(const Laplacian& laplacian, std::span<const VertexPair> pairs,
                         const Connections& connections, ResistanceResult& result) {
  const auto grounded = detail::ground(laplacian);
  // Rows of the grounded matrix; a pair there is nothing to compute for has none.
  std::vector<VertexPair> rows(pairs.size(), {-1, -1});
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (connections.of_query(k) == Connections::kNoPlace) continue;
    rows[k] = {grounded.row_of[pairs[k].from], grounded.row_of[pairs[k].to]};
  }
  const auto matrix = detail::analyse(detail::with_pairs(grounded.lower, rows));
  std::vector<detail::SelectedEntries<double>> entries(pairs.size());
  const auto quality = detail::selected_entries<double>(matrix, detail::locate(matrix.tree, rows),
                                                        1.0, 0.0, entries);
  if (!quality.finite) throw NumericalError("resistance", "the factorisation broke down");
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::size_t place = connections.of_query(k);
    if (place == Connections::kNoPlace) continue;
    result.values[k] = entries[k].difference();
    result.without[k] = leave_one_out_resistance(result.values[k],
                                                 connections.direct(place) * connections.largest());
  }
  result.bound = kInfinity;
  result.residual = quality.residual;
}

}  // namespace

ResistanceResult effective_resistances(const WeightedGraph& graph,
                                       std::span<const VertexPair> pairs) {
  const auto start = std::chrono::steady_clock::now();
  detail::check_pairs(pairs, graph.vertex_count());
  const Laplacian laplacian(graph);
  const auto& component = laplacian.components().label;
  const Connections connections(graph, pairs, component);

  ResistanceResult result;
  for (const auto& [from, to] : pairs) {
    result.values.push_back(component[from] == component[to] ? 0.0 : kInfinity);
  }
  result.without = result.values;
  if (graph.edge_count() > 0 && !resist_by_elimination(laplacian, connections, result)) {
    resist_by_inversion(laplacian, pairs, connections, result);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

ResistanceResult edge_resistances(const WeightedGraph& graph) {
  return effective_resistances(graph, edge_pairs(graph));
}

ResistanceResult commute_times(const WeightedGraph& graph, std::span<const VertexPair> pairs) {
  auto result = effective_resistances(graph, pairs);
  const auto components = connected_components(graph);
  const auto degrees = weighted_degrees(graph);
  std::vector<double> volume(components.count, 0.0);
  for (Index v = 0; v < graph.vertex_count(); ++v) volume[components.label[v]] += degrees[v];
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (pairs[k].from != pairs[k].to) result.values[k] *= volume[components.label[pairs[k].from]];
  }
  return result;
}

double leave_one_out_resistance(double resistance, double weight) {
  constexpr double kBridge = 1e-9;
  const double rest = 1.0 - weight * resistance;
  return rest < kBridge ? kInfinity : resistance / rest;
}

}  // namespace isotherm::spectral
