#include "isotherm/spectral/sparse/inverse_entries.hpp"

#include "isotherm/base/error.hpp"
#include "sparse/inverse/selected_inverse.hpp"
#include "sparse/pair_pattern.hpp"

namespace isotherm::spectral {

InverseEntries inverse_entries(const SparseMatrix& lower, std::span<const VertexPair> pairs) {
  detail::check_pairs(pairs, static_cast<Index>(lower.rows()));
  // A diagonal entry is asked for by a pair with one end.
  std::vector<VertexPair> rows(pairs.begin(), pairs.end());
  for (auto& [from, to] : rows) {
    if (from == to) to = -1;
  }
  const auto matrix = detail::analyse(detail::with_pairs(lower, rows));
  std::vector<detail::SelectedEntries<double>> entries(pairs.size());
  const auto quality = detail::selected_entries<double>(matrix, detail::locate(matrix.tree, rows),
                                                        1.0, 0.0, entries);
  if (!quality.finite) throw NumericalError("selected inversion", "the factorisation broke down");
  InverseEntries result;
  result.residual = quality.residual;
  result.values.reserve(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    result.values.push_back(rows[k].to < 0 ? entries[k].first : entries[k].cross);
  }
  return result;
}

}  // namespace isotherm::spectral
