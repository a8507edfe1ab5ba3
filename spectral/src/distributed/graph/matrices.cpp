#include "distributed/graph/matrices.hpp"

#include <algorithm>
#include <cmath>

namespace isotherm::spectral::distributed::detail {
namespace {

/// One number at a position, or for one.
struct Placed {
  Index position = 0;
  double value = 0.0;
};

}  // namespace

std::uint64_t mixed(std::uint64_t counter) {
  std::uint64_t z = counter * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

LaplacianMatrix::LaplacianMatrix(const Graph::State& graph, LaplacianKind kind)
    : graph_(graph), kind_(kind), norm_(graph.norm_bound) {
  if (kind == LaplacianKind::combinatorial) return;
  if (norm_ > 0.0) norm_ = 2.0;
  auto scaling = make_vector(graph), ones = make_vector(graph);
  {
    const LocalEntries scale(scaling.get()), one(ones.get());
    for (std::size_t k = 0; k < graph.row_count(); ++k) {
      const bool connected = graph.degrees[k] > 0.0;
      scale[k] = connected ? 1.0 / std::sqrt(graph.degrees[k]) : 0.0;
      one[k] = connected ? 1.0 : 0.0;
    }
  }
  check(MatDuplicate(graph.laplacian.get(), MAT_COPY_VALUES, own_.out()));
  check(MatDiagonalScale(own_.get(), scaling.get(), scaling.get()));
  check(MatDiagonalSet(own_.get(), ones.get(), INSERT_VALUES));
  check(MatSetOption(own_.get(), MAT_SYMMETRIC, PETSC_TRUE));
  check(MatSetOption(own_.get(), MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
}

double LaplacianMatrix::null_entry(std::size_t local) const {
  const double degree = graph_.degrees[local];
  return kind_ == LaplacianKind::combinatorial || degree == 0.0 ? 1.0 : std::sqrt(degree);
}

MatHandle incidence(const Graph::State& graph) {
  std::vector<PetscInt> starts = {0}, columns;
  std::vector<double> values;
  for (const auto& edge : graph.edges) {
    if (edge.from != edge.to) {
      const double root = std::sqrt(edge.weight);
      columns.insert(columns.end(), {edge.from, edge.to});
      values.insert(values.end(), {root, -root});
    }
    starts.push_back(static_cast<PetscInt>(columns.size()));
  }
  MatHandle matrix;
  check(MatCreateMPIAIJWithArrays(graph.comm().handle, static_cast<PetscInt>(graph.edges.size()),
                                  static_cast<PetscInt>(graph.row_count()), PETSC_DETERMINE,
                                  static_cast<PetscInt>(graph.rows.total()), starts.data(),
                                  columns.data(), values.data(), matrix.out()));
  return matrix;
}

NullSpace::NullSpace(const LaplacianMatrix& laplacian) : graph_(laplacian.graph()) {
  const auto& components = graph_.components;
  std::vector<double> squared(components.local_count(), 0.0);
  for (std::size_t k = 0; k < graph_.row_count(); ++k) {
    entries_.push_back(laplacian.null_entry(k));
    squared[components.of_row[k]] += entries_[k] * entries_[k];
  }
  components.add_up(graph_.comm(), squared);
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    entries_[k] /= std::sqrt(squared[components.of_row[k]]);
  }
}

void NullSpace::add(Vec x, double factor, Vec y) const {
  const auto& components = graph_.components;
  std::vector<double> parts(components.local_count(), 0.0);
  {
    const double* values = nullptr;
    check(VecGetArrayRead(x, &values));
    for (std::size_t k = 0; k < entries_.size(); ++k) {
      parts[components.of_row[k]] += entries_[k] * values[k];
    }
    check(VecRestoreArrayRead(x, &values));
  }
  components.add_up(graph_.comm(), parts);
  const LocalEntries target(y);
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    target[k] += factor * entries_[k] * parts[components.of_row[k]];
  }
}

VecHandle make_vector(const Graph::State& graph) {
  VecHandle vector;
  check(VecCreateMPI(graph.comm().handle, static_cast<PetscInt>(graph.row_count()),
                     static_cast<PetscInt>(graph.rows.total()), vector.out()));
  return vector;
}

void fill_at_random(const Graph::State& graph, std::uint64_t seed, Vec x) {
  const LocalEntries entries(x);
  const std::uint64_t start = mixed(seed + 1);
  for (std::size_t k = 0; k < graph.row_count(); ++k) {
    const auto bits = mixed(start + static_cast<std::uint64_t>(graph.position_of[k]) + 1);
    entries[k] = std::ldexp(static_cast<double>(bits >> 11), -52) - 1.0;
  }
}

std::vector<double> in_block(const Graph::State& graph, std::span<const double> of_rows) {
  std::vector<Placed> placed;
  placed.reserve(of_rows.size());
  for (std::size_t k = 0; k < of_rows.size(); ++k) {
    placed.push_back({graph.position_of[k], of_rows[k]});
  }
  const auto mine = exchange(graph.comm(), std::span<const Placed>(placed),
                             [&](const Placed& one) { return graph.blocks.owner(one.position); });
  std::vector<double> result(mine.items.size());
  const auto begin = static_cast<Index>(graph.blocks.begin(graph.comm().rank));
  for (const auto& [position, value] : mine.items) result[position - begin] = value;
  return result;
}

std::vector<std::int64_t> component_numbers(const Graph::State& graph) {
  const auto& comm = graph.comm();
  const auto& components = graph.components;
  std::vector<Index> firsts;
  for (std::size_t k = 0; k < components.local_count(); ++k) {
    if (components.first[k]) firsts.push_back(components.label[k]);
  }
  auto mine = exchange(comm, std::span<const Index>(firsts), [&](Index position) {
                return graph.blocks.owner(position);
              }).items;
  std::sort(mine.begin(), mine.end());
  std::vector<std::int64_t> of_block(graph.ids.size(), -1);
  auto number = sum_before(comm, static_cast<std::int64_t>(mine.size()));
  const auto begin = static_cast<Index>(graph.blocks.begin(comm.rank));
  for (const Index position : mine) of_block[position - begin] = number++;
  return look_up(comm, graph.blocks, std::span<const std::int64_t>(of_block),
                 std::span<const Index>(components.label));
}

}  // namespace isotherm::spectral::distributed::detail
