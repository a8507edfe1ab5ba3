#include "sparse/inverse/frontal_matrix.hpp"

#include <algorithm>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::detail {
namespace {

void reorder_entries(const SparseMatrix& lower, FrontalMatrix& matrix) {
  matrix.entry_start.assign(matrix.size() + 1, 0);
  const auto for_each_entry = [&](auto&& visit) {
    for (Index column = 0; column < lower.outerSize(); ++column) {
      for (SparseMatrix::InnerIterator entry(lower, column); entry; ++entry) {
        const Index a = matrix.tree.position(column);
        const Index b = matrix.tree.position(static_cast<Index>(entry.row()));
        visit(std::min(a, b), std::max(a, b), entry.value());
      }
    }
  };
  for_each_entry([&](Index column, Index, double) { ++matrix.entry_start[column + 1]; });
  for (Index c = 0; c < matrix.size(); ++c) matrix.entry_start[c + 1] += matrix.entry_start[c];
  matrix.entry_row.resize(matrix.entry_start.back());
  matrix.entry_value.resize(matrix.entry_start.back());
  auto next = matrix.entry_start;
  for_each_entry([&](Index column, Index row, double value) {
    matrix.entry_row[next[column]] = row;
    matrix.entry_value[next[column]++] = value;
  });
}

}  // namespace

FrontalMatrix analyse(const SparseMatrix& lower) {
  FrontalMatrix matrix;
  if (lower.rows() == 0) return matrix;
  const CholmodFactor factor(lower_triangle(lower), FactorKind::supernodal);
  matrix.tree = FrontTree(factor.supernodes(), 1);
  matrix.flops = factor.flops();
  matrix.entries = factor.entries();
  reorder_entries(lower, matrix);
  return matrix;
}

FrontQueries locate(const FrontTree& tree, std::span<const VertexPair> pairs) {
  struct Located {
    Index front;
    FrontQuery query;
  };
  const auto front_place = [&](Index front, Index row) {
    const Index place = tree.place(front, row);
    if (place == FrontTree::kNone) {
      throw InvalidArgument("pairs", "a pair lies outside the pattern of the factor");
    }
    return place;
  };

  std::vector<Located> located;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    auto [low, high] = pairs[k];
    if (low < 0) std::swap(low, high);
    if (low < 0) continue;
    const bool swapped = high >= 0 && tree.position(high) < tree.position(low);
    if (swapped) std::swap(low, high);
    const Index front = tree.front_of(low);
    const Index second = high < 0 ? FrontTree::kNone : front_place(front, high);
    located.push_back({front, {static_cast<Index>(k), front_place(front, low), second, swapped}});
  }

  FrontQueries result;
  result.start.assign(tree.front_count() + 1, 0);
  for (const auto& item : located) ++result.start[item.front + 1];
  for (std::size_t s = 1; s < result.start.size(); ++s) result.start[s] += result.start[s - 1];
  result.queries.resize(located.size());
  auto next = result.start;
  for (const auto& item : located) result.queries[next[item.front]++] = item.query;
  return result;
}

}  // namespace isotherm::spectral::detail
