#include "isotherm/spectral/resistance/effective_resistance.hpp"

#include <chrono>
#include <limits>
#include <string>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"
#include "sparse/inverse/selected_inverse.hpp"
#include "sparse/laplacian/grounded_laplacian.hpp"
#include "sparse/pair_pattern.hpp"

namespace isotherm::spectral {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

ResistanceResult effective_resistances(const WeightedGraph& graph,
                                       std::span<const VertexPair> pairs) {
  const auto start = std::chrono::steady_clock::now();
  detail::check_pairs(pairs, graph.vertex_count());
  const Laplacian laplacian(graph);
  const auto grounded = detail::ground(laplacian);
  const auto& component = laplacian.components().label;

  ResistanceResult result;
  result.values.assign(pairs.size(), 0.0);
  // Rows of the grounded matrix; a pair there is nothing to compute for has none.
  std::vector<VertexPair> rows(pairs.size(), {-1, -1});
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [from, to] = pairs[k];
    if (component[from] != component[to]) {
      result.values[k] = kInfinity;
    } else if (from != to) {
      rows[k] = {grounded.row_of[from], grounded.row_of[to]};
    }
  }
  const auto matrix = detail::analyse(detail::with_pairs(grounded.lower, rows));
  std::vector<detail::SelectedEntries<double>> entries(pairs.size());
  const auto quality = detail::selected_entries<double>(matrix, detail::locate(matrix.tree, rows),
                                                        1.0, 0.0, entries);
  if (!quality.finite) throw NumericalError("resistance", "the factorisation broke down");
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (result.values[k] == 0.0) result.values[k] = entries[k].difference();
  }
  result.residual = quality.residual;
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
