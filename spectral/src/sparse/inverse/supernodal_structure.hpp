#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

/// Where the factors of every matrix with one symmetric pattern have their
/// entries, as a tree of dense fronts.
///
/// Supernode s owns the columns [first_column[s], first_column[s + 1]) of the
/// reordered matrix. Its front has the rows rows[row_start[s] ...
/// row_start[s + 1]), ascending, its own columns first. The others are rows of
/// its parent's front too; place_in_parent says where.
struct SupernodalStructure {
  Index size = 0;                  ///< of the matrix
  std::vector<Index> position_of;  ///< row of the matrix -> row after reordering
  std::vector<Index> first_column;
  std::vector<Index> supernode_of;  ///< column -> supernode
  std::vector<Index> row_start;
  std::vector<Index> rows;
  std::vector<Index> place_in_parent;  ///< like `rows`; meaningless for own columns
  std::vector<Index> parent;           ///< -1 for roots; larger than the child otherwise
  std::vector<Index> child_count;
  std::vector<std::int64_t> block_start;  ///< of the (rows x own columns) blocks, stored densely

  /// Lower triangle of the reordered matrix, by columns.
  std::vector<Index> entry_start;
  std::vector<Index> entry_row;
  std::vector<double> entry_value;

  Index largest_front = 0;
  double flops = 0.0;    ///< of one real Cholesky factorisation
  double entries = 0.0;  ///< of the factor

  Index supernode_count() const { return static_cast<Index>(first_column.size()) - 1; }
  Index front_size(Index s) const { return row_start[s + 1] - row_start[s]; }
  Index width(Index s) const { return first_column[s + 1] - first_column[s]; }
};

/// Orders the matrix for little fill (CHOLMOD: the better of AMD and METIS).
/// `lower` holds the lower triangle of a symmetric matrix with its diagonal.
/// @throws NumericalError if the analysis runs out of memory.
SupernodalStructure analyse(const SparseMatrix& lower);

/// Where the fronts hold what a pair of rows asks for.
struct FrontQuery {
  Index pair = 0;        ///< position in the list of pairs
  Index first = 0;       ///< row of the front
  Index second = 0;      ///< another one, or -1 for a single diagonal entry
  bool swapped = false;  ///< `first` belongs to the second row of the pair
};

/// The queries of each supernode: those of s are
/// queries[start[s] ... start[s + 1]).
struct FrontQueries {
  std::vector<Index> start;
  std::vector<FrontQuery> queries;
};

/// Finds the front that holds each pair of matrix rows. A pair with one
/// negative end asks for one diagonal entry; one with two is left out.
/// @throws InvalidArgument for a pair outside the pattern of the factor.
FrontQueries locate(const SupernodalStructure& structure, std::span<const VertexPair> pairs);

}  // namespace isotherm::spectral::detail
