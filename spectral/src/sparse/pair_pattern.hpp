#pragma once

#include <span>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

/// @throws InvalidArgument naming the first pair with a vertex outside the graph.
void check_pairs(std::span<const VertexPair> pairs, Index vertex_count);

/// The lower triangular matrix `lower` with explicit zeros where pairs of rows
/// are missing from its pattern, so that a factorisation makes room for them.
/// Pairs with a negative end are left out. O(entries + pairs log pairs).
SparseMatrix with_pairs(const SparseMatrix& lower, std::span<const VertexPair> pairs);

}  // namespace isotherm::spectral::detail
