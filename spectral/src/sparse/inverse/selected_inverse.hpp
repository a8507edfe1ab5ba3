#pragma once

#include <complex>
#include <span>

#include "sparse/inverse/frontal_matrix.hpp"

namespace isotherm::spectral::detail {

/// How well a selected inversion went.
struct SelectedInverseQuality {
  /// Largest |(A Z)_jj - 1| over the columns, Z being the inverse found: every
  /// entry of Z in the pattern of A takes part.
  double residual = 0.0;
  bool finite = true;
};

/// The entries Z_ii, Z_jj and Z_ij of an inverse that belong to a pair (i, j);
/// the last two are 0 for a single row.
template <class Scalar>
struct SelectedEntries {
  Scalar first{};
  Scalar second{};
  Scalar cross{};

  /// (e_i - e_j)' Z (e_i - e_j), or Z_ii.
  Scalar difference() const { return first + second - 2.0 * cross; }
};

/// For every query the entries of Z = (scale * M + shift * I)^-1, M being the
/// matrix that was analysed: `entries[query.pair]` is written.
///
/// A multifrontal LDL' factorisation without pivoting, then Takahashi's
/// recurrence from the root down (Takahashi, Fagan and Chin 1973; Erisman and
/// Tinney 1975) with dense fronts, so that only entries in the factor's pattern
/// are ever formed and all pairs together cost about two factorisations more.
/// Stable where scale * M + shift * I is positive definite or has a definite
/// imaginary part, which bounds every pivot from below. Scalar is double or
/// std::complex<double>.
template <class Scalar>
SelectedInverseQuality selected_entries(const FrontalMatrix& matrix, const FrontQueries& queries,
                                        double scale, Scalar shift,
                                        std::span<SelectedEntries<Scalar>> entries);

}  // namespace isotherm::spectral::detail
