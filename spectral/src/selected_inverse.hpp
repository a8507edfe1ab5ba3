#pragma once

#include <complex>
#include <span>

#include "supernodal_structure.hpp"

namespace isotherm::spectral::detail {

/// How well a selected inversion went.
struct SelectedInverseQuality {
  /// Largest |(A Z)_jj - 1| over the columns, Z being the inverse found: every
  /// entry of Z in the pattern of A takes part.
  double residual = 0.0;
  bool finite = true;
};

/// For every query pair (i, j) the value Z_ii + Z_jj - 2 Z_ij, or Z_ii for a
/// single row, of Z = (scale * M + shift * I)^-1, M being the matrix that was
/// analysed: `values[query.pair]` is written.
///
/// A multifrontal LDL' factorisation without pivoting, then Takahashi's
/// recurrence from the root down (Takahashi, Fagan and Chin 1973; Erisman and
/// Tinney 1975) with dense fronts, so that only entries in the factor's pattern
/// are ever formed and all pairs together cost about two factorisations more.
/// Stable where scale * M + shift * I is positive definite or has a definite
/// imaginary part, which bounds every pivot from below. Scalar is double or
/// std::complex<double>.
template <class Scalar>
SelectedInverseQuality selected_differences(const SupernodalStructure& structure,
                                            const FrontQueries& queries, double scale, Scalar shift,
                                            std::span<Scalar> values);

}  // namespace isotherm::spectral::detail
