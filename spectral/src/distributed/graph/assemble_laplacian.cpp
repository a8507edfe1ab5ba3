#include <algorithm>
#include <tuple>
#include <vector>

#include "distributed/graph/build_graph.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

/// An edge as its row sees it.
struct Entry {
  Index row = 0;
  Index column = 0;
  double weight = 0.0;
  std::int64_t place = 0;
};

std::vector<Entry> entries_of(const Graph::State& graph) {
  std::vector<Entry> entries;
  entries.reserve(2 * graph.edges.size());
  for (const auto& [from, to, weight, place] : graph.edges) {
    if (from == to) continue;
    entries.push_back({from, to, weight, place});
    entries.push_back({to, from, weight, place});
  }
  return exchange(graph.comm(), std::span<const Entry>(entries),
                  [&](const Entry& entry) { return graph.rows.owner(entry.row); })
      .items;
}

/// Rows of the matrix that this rank has, the diagonal among the other entries.
struct Csr {
  std::vector<PetscInt> starts = {0};
  std::vector<PetscInt> columns;
  std::vector<double> values;

  void add(PetscInt column, double value) {
    columns.push_back(column);
    values.push_back(value);
  }
};

Csr csr_of(const Graph::State& graph, std::span<const Entry> entries) {
  Csr csr;
  csr.columns.reserve(entries.size() + graph.row_count());
  csr.values.reserve(entries.size() + graph.row_count());
  std::size_t k = 0;
  for (std::size_t local = 0; local < graph.row_count(); ++local) {
    const Index row = graph.first_row() + static_cast<Index>(local);
    bool diagonal_done = false;
    while (k < entries.size() && entries[k].row == row) {
      const Index column = entries[k].column;
      if (column > row && !std::exchange(diagonal_done, true)) csr.add(row, graph.degrees[local]);
      double total = 0.0;  // of parallel edges
      for (; k < entries.size() && entries[k].row == row && entries[k].column == column; ++k) {
        total -= entries[k].weight;
      }
      csr.add(column, total);
    }
    if (!diagonal_done) csr.add(row, graph.degrees[local]);
    csr.starts.push_back(static_cast<PetscInt>(csr.columns.size()));
  }
  return csr;
}

}  // namespace

void assemble_laplacian(Graph::State& graph) {
  auto entries = entries_of(graph);
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tuple(a.place, a.row) < std::tuple(b.place, b.row);
  });
  graph.degrees.assign(graph.row_count(), 0.0);
  for (const auto& entry : entries) graph.degrees[entry.row - graph.first_row()] += entry.weight;
  double largest = 0.0;
  for (const double degree : graph.degrees) largest = std::max(largest, degree);
  graph.norm_bound = 2.0 * most(graph.comm(), largest);

  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tuple(a.row, a.column, a.place) < std::tuple(b.row, b.column, b.place);
  });
  const Csr csr = csr_of(graph, entries);
  std::vector<Entry>().swap(entries);
  const auto count = static_cast<PetscInt>(graph.row_count());
  const auto total = static_cast<PetscInt>(graph.rows.total());
  check(MatCreateMPIAIJWithArrays(graph.comm().handle, count, count, total, total,
                                  csr.starts.data(), csr.columns.data(), csr.values.data(),
                                  graph.laplacian.out()));
  check(MatSetOption(graph.laplacian.get(), MAT_SYMMETRIC, PETSC_TRUE));
  check(MatSetOption(graph.laplacian.get(), MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
}

}  // namespace isotherm::spectral::distributed::detail
