#include "isotherm/spectral/graph/laplacian.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace isotherm::spectral {
namespace {

SparseMatrix combinatorial_matrix(const WeightedGraph& graph, const Eigen::VectorXd& degrees) {
  struct Entry {
    Index row;
    double value;
  };
  SparseMatrix matrix(graph.vertex_count(), graph.vertex_count());
  matrix.reserve(static_cast<Index>(2 * graph.edges().size()) + graph.vertex_count());
  std::vector<Entry> column;
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    column.assign(1, {v, degrees[v]});
    for (const auto& neighbour : graph.neighbours(v)) {
      if (neighbour.vertex == v) continue;
      column.push_back({neighbour.vertex, -graph.edge(neighbour.edge).weight});
    }
    std::stable_sort(column.begin(), column.end(),
                     [](const Entry& a, const Entry& b) { return a.row < b.row; });
    matrix.startVec(v);
    for (std::size_t k = 0; k < column.size();) {
      const Index row = column[k].row;
      double sum = 0.0;  // of parallel edges, in order of id
      for (; k < column.size() && column[k].row == row; ++k) sum += column[k].value;
      matrix.insertBack(row, v) = sum;
    }
  }
  matrix.finalize();
  return matrix;
}

double inverse_root(double degree) { return degree > 0.0 ? 1.0 / std::sqrt(degree) : 0.0; }

void normalise(SparseMatrix& matrix, const Eigen::VectorXd& degrees) {
  for (Index column = 0; column < matrix.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry) {
      if (entry.row() == column) {
        entry.valueRef() = degrees[column] > 0.0 ? 1.0 : 0.0;
      } else {
        entry.valueRef() *= inverse_root(degrees[column]) * inverse_root(degrees[entry.row()]);
      }
    }
  }
}

}  // namespace

Laplacian::Laplacian(const WeightedGraph& graph, LaplacianKind kind)
    : matrix_(),
      kind_(kind),
      degrees_(weighted_degrees(graph)),
      components_(connected_components(graph)) {
  matrix_ = combinatorial_matrix(graph, degrees_);
  norm_bound_ = degrees_.size() > 0 ? 2.0 * degrees_.maxCoeff() : 0.0;
  if (kind == LaplacianKind::normalised) {
    normalise(matrix_, degrees_);
    if (norm_bound_ > 0.0) norm_bound_ = 2.0;
  }
}

SparseMatrix Laplacian::null_space() const {
  const auto entry_of = [this](Index v) {
    if (kind_ == LaplacianKind::combinatorial || degrees_[v] == 0.0) return 1.0;
    return std::sqrt(degrees_[v]);
  };
  Eigen::VectorXd squared = Eigen::VectorXd::Zero(components_.count);
  for (Index v = 0; v < size(); ++v) squared[components_.label[v]] += entry_of(v) * entry_of(v);

  std::vector<Eigen::Triplet<double, Index>> entries;
  entries.reserve(static_cast<std::size_t>(size()));
  for (Index v = 0; v < size(); ++v) {
    const Index component = components_.label[v];
    entries.emplace_back(v, component, entry_of(v) / std::sqrt(squared[component]));
  }
  SparseMatrix basis(size(), components_.count);
  basis.setFromTriplets(entries.begin(), entries.end());
  return basis;
}

}  // namespace isotherm::spectral
