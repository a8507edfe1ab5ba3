#pragma once

#include <span>
#include <vector>

#include "isotherm/spectral/types.hpp"
#include "sparse/inverse/frontal_matrix.hpp"

namespace isotherm::spectral::detail {

/// A pair of rows of a front and the conductance of the edge between them, 0 where there is none.
struct PairOfFront {
  Index pair = 0;   ///< position in the list of pairs
  Index first = 0;  ///< rows of the front, first < second
  Index second = 0;
  double direct = 0.0;
};

/// The conductance that all else gives the ends of each pair, whatever edge joins them itself:
/// `rest[pair]`, 0 only where all else does not join them.
///
/// Vertices are eliminated by star-mesh transforms (A. Kennelly 1899; Kron reduction), in which
/// nothing is ever subtracted: up the tree of fronts, then down, where each child and each pair
/// gets what all others of a front say, by halving the list of them. A relative error of the
/// conductances changes an effective conductance by no more than itself (Rayleigh's monotonicity),
/// so that the rounding errors of all eliminations just add up, whatever the weights are.
/// @param pairs by front; every edge of the graph must be among them
std::vector<double> rest_conductances(const FrontTree& tree,
                                      const std::vector<std::vector<PairOfFront>>& pairs,
                                      std::size_t pair_count);

/// A bound on their relative error.
double kron_rounding(const FrontTree& tree, std::size_t pair_count);

}  // namespace isotherm::spectral::detail
