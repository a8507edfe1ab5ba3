#pragma once

#include <chrono>
#include <vector>

#include <cholmod.h>

#include "isotherm/spectral/graph/weighted_graph.hpp"

/// One factorisation as a user of CHOLMOD would do it, for comparison.
namespace isotherm_bench {

struct CholmodTiming {
  double analyse = 0.0;    ///< seconds, wall clock
  double factorise = 0.0;  ///< seconds, wall clock
};

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Analyses and factorises a graph's Laplacian without its first vertex, with
/// CHOLMOD's default settings.
inline CholmodTiming time_cholmod(const isotherm::spectral::WeightedGraph& graph) {
  cholmod_common common;
  cholmod_start(&common);
  const auto size = static_cast<std::size_t>(graph.vertex_count() - 1);
  const auto degrees = isotherm::spectral::weighted_degrees(graph);
  cholmod_triplet* triplets =
      cholmod_allocate_triplet(size, size, size + graph.edges().size(), -1, CHOLMOD_REAL, &common);
  auto* rows = static_cast<int*>(triplets->i);
  auto* columns = static_cast<int*>(triplets->j);
  auto* values = static_cast<double*>(triplets->x);
  const auto add = [&](int row, int column, double value) {
    rows[triplets->nnz] = row;
    columns[triplets->nnz] = column;
    values[triplets->nnz++] = value;
  };
  for (std::size_t v = 0; v < size; ++v) {
    add(static_cast<int>(v), static_cast<int>(v), degrees[static_cast<Eigen::Index>(v + 1)]);
  }
  for (const auto& edge : graph.edges()) {
    const auto [low, high] = std::minmax(edge.from, edge.to);
    if (low > 0 && low != high) add(high - 1, low - 1, -edge.weight);
  }
  cholmod_sparse* matrix = cholmod_triplet_to_sparse(triplets, 0, &common);
  CholmodTiming timing;
  auto start = std::chrono::steady_clock::now();
  cholmod_factor* factor = cholmod_analyze(matrix, &common);
  timing.analyse = seconds_since(start);
  start = std::chrono::steady_clock::now();
  cholmod_factorize(matrix, factor, &common);
  timing.factorise = seconds_since(start);
  cholmod_free_factor(&factor, &common);
  cholmod_free_sparse(&matrix, &common);
  cholmod_free_triplet(&triplets, &common);
  cholmod_finish(&common);
  return timing;
}

}  // namespace isotherm_bench
