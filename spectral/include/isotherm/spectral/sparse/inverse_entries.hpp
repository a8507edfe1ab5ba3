#pragma once

#include <span>
#include <vector>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral {

/// Entries of the inverse of a sparse symmetric positive definite matrix.
struct InverseEntries {
  std::vector<double> values;  ///< one a pair
  /// Largest |(A Z)_jj - 1| over the columns, Z being the inverse found.
  double residual = 0.0;
};

/// (A^-1)_ij for every pair (i, j) of rows, by selected inversion: the cost is
/// that of a few factorisations, whatever the number of pairs, as long as few of
/// them lie outside the pattern of A.
/// `lower` holds the lower triangle of A with its diagonal.
/// @throws InvalidArgument for a row outside the matrix, NumericalError if the
///   factorisation breaks down.
InverseEntries inverse_entries(const SparseMatrix& lower, std::span<const VertexPair> pairs);

}  // namespace isotherm::spectral
