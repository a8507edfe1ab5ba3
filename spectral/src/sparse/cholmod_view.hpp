#pragma once

#include <cholmod.h>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

/// The lower triangle of `matrix` as CHOLMOD sees it, without copying.
inline cholmod_sparse cholmod_lower_view(const SparseMatrix& matrix) {
  cholmod_sparse view = {};
  view.nrow = static_cast<std::size_t>(matrix.rows());
  view.ncol = static_cast<std::size_t>(matrix.cols());
  view.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  view.p = const_cast<Index*>(matrix.outerIndexPtr());
  view.i = const_cast<Index*>(matrix.innerIndexPtr());
  view.x = const_cast<double*>(matrix.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

}  // namespace isotherm::spectral::detail
