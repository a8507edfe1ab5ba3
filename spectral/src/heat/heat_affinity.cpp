#include "isotherm/spectral/heat/heat_affinity.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "heat/heat_engine.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"
#include "sparse/pair_pattern.hpp"

namespace isotherm::spectral {
namespace {

using detail::HeatTable;
using detail::HeatTarget;

/// Where the table of heat kernel diagonals has the two ends of each pair.
struct EndRows {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// (h_ii + h_jj - D) / 2 / sqrt(h_ii h_jj), which falls with D and, given the
/// others, lies between its values at the corners of the box they span.
double cosine(double first, double second, double distance) {
  if (!(first > 0.0) || !(second > 0.0)) return 0.0;
  return std::clamp(0.5 * (first + second - distance) / std::sqrt(first * second), 0.0, 1.0);
}

CertifiedValue affinity(const CertifiedValue& first, const CertifiedValue& second,
                        const CertifiedValue& distance) {
  CertifiedValue result;
  result.value = cosine(first.value, second.value, distance.value);
  // h_ij and the diagonal are bounded apart, which no correlation can undo.
  const double inner_low = 0.5 * (first.lower + second.lower - distance.upper);
  const double inner_high = 0.5 * (first.upper + second.upper - distance.lower);
  const double norm_low = std::sqrt(first.lower * second.lower);
  const double norm_high = std::sqrt(first.upper * second.upper);
  result.lower = norm_high > 0.0 ? std::clamp(inner_low / norm_high, 0.0, 1.0) : 0.0;
  result.upper = norm_low > 0.0 ? std::clamp(inner_high / norm_low, 0.0, 1.0) : 1.0;
  result.value = std::clamp(result.value, result.lower, result.upper);
  return result;
}

HeatAffinityResult combine(std::span<const double> scales, const HeatTable& distances,
                           const HeatTable& diagonals, std::span<const EndRows> ends) {
  HeatAffinityResult result;
  result.scales.assign(scales.begin(), scales.end());
  const std::size_t count = scales.size();
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const bool same = ends[k].from == ends[k].to;
    for (std::size_t s = 0; s < count; ++s) {
      const auto value = same ? CertifiedValue{1.0, 1.0, 1.0}
                              : affinity(diagonals.values[ends[k].from * count + s],
                                         diagonals.values[ends[k].to * count + s],
                                         distances.values[k * count + s]);
      result.widest = std::max(result.widest, value.width());
      if (!is_precise(value)) ++result.imprecise;
      result.values.push_back(value);
    }
  }
  return result;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Sum of the weights of the other edges between the ends of `edge`.
double parallel_weight(const WeightedGraph& graph, Index edge) {
  const auto [from, to, weight] = graph.edge(edge);
  double sum = 0.0;
  for (const auto& neighbour : graph.neighbours(from)) {
    if (neighbour.vertex == to && neighbour.edge != edge) sum += graph.edge(neighbour.edge).weight;
  }
  return sum;
}

}  // namespace

std::vector<double> HeatAffinityResult::column(std::size_t scale) const {
  std::vector<double> column;
  for (std::size_t k = scale; k < values.size(); k += scales.size()) {
    column.push_back(values[k].value);
  }
  return column;
}

HeatAffinityResult heat_affinities(const WeightedGraph& graph, std::span<const VertexPair> pairs,
                                   std::span<const double> scales,
                                   const HeatDistanceOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  options.validate();
  detail::check_pairs(pairs, graph.vertex_count());
  detail::check_scales(scales);

  // Pairs share vertices, so each vertex's own entry is found once.
  constexpr Index kUnseen = -1;
  std::vector<Index> row_of(graph.vertex_count(), kUnseen);
  std::vector<HeatTarget> vertices, differences;
  std::vector<EndRows> ends;
  const auto row = [&](Index vertex) {
    if (row_of[vertex] == kUnseen) {
      row_of[vertex] = static_cast<Index>(vertices.size());
      vertices.push_back({vertex});
    }
    return static_cast<std::size_t>(row_of[vertex]);
  };
  for (const auto& pair : pairs) {
    differences.push_back({pair.from, pair.to});
    ends.push_back({row(pair.from), row(pair.to)});
  }
  const SparseMatrix laplacian = Laplacian(graph).matrix();
  const detail::HeatEngine engine(laplacian, options);
  auto result = combine(scales, engine.evaluate(differences, scales, {}),
                        engine.evaluate(vertices, scales, {}), ends);
  result.seconds = seconds_since(start);
  return result;
}

HeatAffinityResult leave_one_out_affinities(const WeightedGraph& graph,
                                            std::span<const Index> edges,
                                            std::span<const double> scales,
                                            const HeatDistanceOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  options.validate();
  detail::check_scales(scales);
  std::vector<HeatTarget> vertices, differences;
  std::vector<EndRows> ends;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (edges[k] < 0 || edges[k] >= graph.edge_count()) {
      throw InvalidArgument("edges[" + std::to_string(k) + "]", "no such edge");
    }
    const auto [from, to, weight] = graph.edge(edges[k]);
    const bool loop = from == to;
    detail::ExcludedEdge excluded;
    if (!loop) excluded = {from, to, weight, parallel_weight(graph, edges[k])};
    const std::size_t first = vertices.size();
    vertices.push_back({from, detail::kNoVertex, excluded});
    if (!loop) vertices.push_back({to, detail::kNoVertex, excluded});
    differences.push_back({from, to, excluded});
    ends.push_back({first, vertices.size() - 1});
  }
  const SparseMatrix laplacian = Laplacian(graph).matrix();
  const detail::HeatEngine engine(laplacian, options);
  auto result = combine(scales, engine.evaluate(differences, scales, {}),
                        engine.evaluate(vertices, scales, {}), ends);
  result.seconds = seconds_since(start);
  return result;
}

}  // namespace isotherm::spectral
