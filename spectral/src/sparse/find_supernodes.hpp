#pragma once

#include <span>
#include <vector>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

struct LowerTriangle;

/// Where a factor's dense blocks of columns are; fields as in Supernodes.
struct SupernodeLayout {
  std::vector<Index> first_column;
  std::vector<Index> row_start;
  std::vector<Index> rows;
  std::vector<Index> value_start;  ///< and the end
};

/// Runs of columns of L whose rows below are the same, or so nearly that the zeros which
/// joining them stores cost less than a block of its own (Liu, Ng and Peyton 1993; Ashcraft
/// and Grimes 1989). Cost: that of writing the rows of every such run, and the
/// matrix, once.
/// @param order of elimination; a postorder of the elimination tree
/// @throws NumericalError if 32-bit indices cannot count the factor
SupernodeLayout find_supernodes(const LowerTriangle& pattern, std::span<const Index> order);

}  // namespace isotherm::spectral::detail
