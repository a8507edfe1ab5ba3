#include "distributed/eigen/grounded.hpp"

#include <limits>

namespace isotherm::spectral::distributed::detail {
namespace {

/// Of each component the vertex of largest degree, the first of equals: this rank's of these.
std::vector<std::size_t> vertices_of_largest_degree(const Graph::State& graph) {
  constexpr double kLowest = -std::numeric_limits<double>::infinity();
  const auto& components = graph.components;
  std::vector<double> largest(components.local_count(), kLowest), first = largest;
  for (std::size_t k = 0; k < graph.row_count(); ++k) {
    auto& value = largest[components.of_row[k]];
    value = std::max(value, graph.degrees[k]);
  }
  components.take_largest(graph.comm(), largest);
  for (std::size_t k = 0; k < graph.row_count(); ++k) {
    const Index component = components.of_row[k];
    if (graph.degrees[k] < largest[component]) continue;
    first[component] = std::max(first[component], -static_cast<double>(graph.position_of[k]));
  }
  components.take_largest(graph.comm(), first);
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < graph.row_count(); ++k) {
    if (-static_cast<double>(graph.position_of[k]) == first[components.of_row[k]]) {
      rows.push_back(k);
    }
  }
  return rows;
}

}  // namespace

Grounded::Grounded(const LaplacianMatrix& laplacian)
    : graph_(laplacian.graph()), rows_(vertices_of_largest_degree(laplacian.graph())) {
  const auto& graph = laplacian.graph();
  std::vector<PetscInt> rows;
  for (const auto row : rows_) rows.push_back(graph.first_row() + static_cast<PetscInt>(row));
  check(MatDuplicate(laplacian.get(), MAT_COPY_VALUES, matrix_.out()));
  const double diagonal = laplacian.norm() > 0.0 ? 0.5 * laplacian.norm() : 1.0;
  check(MatZeroRowsColumns(matrix_.get(), static_cast<PetscInt>(rows.size()), rows.data(), diagonal,
                           nullptr, nullptr));
  check(MatSetOption(matrix_.get(), MAT_SYMMETRIC, PETSC_TRUE));
  check(MatSetOption(matrix_.get(), MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  check(MatSetOption(matrix_.get(), MAT_SPD, PETSC_TRUE));
}

void Grounded::shift_to_ground(Vec x) const {
  const auto& components = graph_.components;
  std::vector<double> level(components.local_count(), 0.0);
  const LocalEntries entries(x);
  for (const auto row : rows_) level[components.of_row[row]] = entries[row];
  components.add_up(graph_.comm(), level);
  for (std::size_t k = 0; k < graph_.row_count(); ++k) {
    entries[k] -= level[components.of_row[k]];
  }
}

void Grounded::ground(Vec x) const {
  const LocalEntries entries(x);
  for (const auto row : rows_) entries[row] = 0.0;
}

}  // namespace isotherm::spectral::distributed::detail
