#pragma once

#include <vector>

#include "isotherm/spectral/graph/laplacian.hpp"

namespace isotherm::spectral::detail {

/// A Laplacian without one vertex per component, which makes it positive
/// definite. The vertex of largest degree is taken out, for the
/// least fill.
struct GroundedLaplacian {
  SparseMatrix lower;            ///< lower triangle, in order of vertices
  std::vector<Index> row_of;     ///< vertex -> row, or -1 for grounded vertices
  std::vector<Index> vertex_of;  ///< row -> vertex
};

/// O(n + m).
GroundedLaplacian ground(const Laplacian& laplacian);

}  // namespace isotherm::spectral::detail
