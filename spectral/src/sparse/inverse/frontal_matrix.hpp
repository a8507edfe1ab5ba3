#pragma once

#include <span>
#include <vector>

#include "isotherm/spectral/types.hpp"
#include "sparse/inverse/front_tree.hpp"

namespace isotherm::spectral::detail {

/// A sparse symmetric matrix with a tree of dense fronts, in which the factor of every
/// matrix of its pattern has its entries.
struct FrontalMatrix {
  FrontTree tree;

  /// Lower triangle in order of elimination, by columns.
  std::vector<Index> entry_start;
  std::vector<Index> entry_row;
  std::vector<double> entry_value;

  double flops = 0.0;    ///< of one real Cholesky factorisation
  double entries = 0.0;  ///< of the factor

  Index size() const { return tree.block_count(); }
};

/// Orders the matrix for little fill (CHOLMOD: the better of AMD and METIS).
/// `lower` holds the lower triangle of a symmetric matrix with its diagonal.
/// @throws NumericalError if the analysis runs out of memory.
FrontalMatrix analyse(const SparseMatrix& lower);

/// Where the fronts hold what a pair of rows asks for.
struct FrontQuery {
  Index pair = 0;        ///< position in the list of pairs
  Index first = 0;       ///< row of the front
  Index second = 0;      ///< another one, or -1 for a single diagonal entry
  bool swapped = false;  ///< `first` belongs to the second row of the pair
};

/// The queries of each front: those of f are queries[start[f] ... start[f + 1]).
struct FrontQueries {
  std::vector<Index> start;
  std::vector<FrontQuery> queries;
};

/// Finds the front that holds each pair of matrix rows. A pair with one
/// negative end asks for one diagonal entry; one with two is left out.
/// @throws InvalidArgument for a pair outside the pattern of the factor.
FrontQueries locate(const FrontTree& tree, std::span<const VertexPair> pairs);

}  // namespace isotherm::spectral::detail
