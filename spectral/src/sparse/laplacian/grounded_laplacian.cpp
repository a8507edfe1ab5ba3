#include "sparse/laplacian/grounded_laplacian.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr Index kGrounded = -1;

std::vector<Index> vertices_of_largest_degree(const Laplacian& laplacian) {
  const auto& components = laplacian.components();
  std::vector<Index> best(components.count, kGrounded);
  for (Index v = 0; v < laplacian.size(); ++v) {
    auto& candidate = best[components.label[v]];
    if (candidate == kGrounded || laplacian.degrees()[v] > laplacian.degrees()[candidate]) {
      candidate = v;
    }
  }
  return best;
}

}  // namespace

GroundedLaplacian ground(const Laplacian& laplacian) {
  GroundedLaplacian grounded;
  grounded.row_of.assign(laplacian.size(), 0);
  for (const Index vertex : vertices_of_largest_degree(laplacian)) {
    grounded.row_of[vertex] = kGrounded;
  }
  for (Index v = 0; v < laplacian.size(); ++v) {
    if (grounded.row_of[v] == kGrounded) continue;
    grounded.row_of[v] = static_cast<Index>(grounded.vertex_of.size());
    grounded.vertex_of.push_back(v);
  }

  const auto rows = static_cast<Index>(grounded.vertex_of.size());
  const auto& matrix = laplacian.matrix();
  grounded.lower.resize(rows, rows);
  grounded.lower.reserve(matrix.nonZeros() / 2 + rows);
  for (Index column = 0; column < rows; ++column) {
    grounded.lower.startVec(column);
    for (SparseMatrix::InnerIterator entry(matrix, grounded.vertex_of[column]); entry; ++entry) {
      const Index row = grounded.row_of[entry.row()];
      if (row >= column) grounded.lower.insertBack(row, column) = entry.value();
    }
  }
  grounded.lower.finalize();
  return grounded;
}

}  // namespace isotherm::spectral::detail
