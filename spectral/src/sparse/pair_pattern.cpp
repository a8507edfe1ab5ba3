#include "sparse/pair_pattern.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::detail {

void check_pairs(std::span<const VertexPair> pairs, Index vertex_count) {
  const auto inside = [vertex_count](Index v) { return v >= 0 && v < vertex_count; };
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (inside(pairs[k].from) && inside(pairs[k].to)) continue;
    throw InvalidArgument("pairs[" + std::to_string(k) + "]",
                          "vertex outside [0, " + std::to_string(vertex_count) + ")");
  }
}

SparseMatrix with_pairs(const SparseMatrix& lower, std::span<const VertexPair> pairs) {
  std::vector<Eigen::Triplet<double, Index>> missing;
  for (const auto& [from, to] : pairs) {
    if (from < 0 || to < 0) continue;
    const auto [column, row] = std::minmax(from, to);
    const auto begin = lower.innerIndexPtr() + lower.outerIndexPtr()[column];
    const auto end = lower.innerIndexPtr() + lower.outerIndexPtr()[column + 1];
    if (!std::binary_search(begin, end, row)) missing.emplace_back(row, column, 0.0);
  }
  if (missing.empty()) return lower;
  SparseMatrix zeros(lower.rows(), lower.cols());
  zeros.setFromTriplets(missing.begin(), missing.end());
  return lower + zeros;
}

}  // namespace isotherm::spectral::detail
