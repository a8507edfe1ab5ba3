#pragma once

#include <array>
#include <span>

#include "heat/rational_exponential_table.hpp"

namespace isotherm::spectral::detail {

/// The quadrature sums e_1' exp(-t T) e_1 of symmetric positive semidefinite
/// tridiagonal (Jacobi) matrices T, through a rational approximation of exp:
/// each term is a continued fraction, O(m), instead of an O(m^2)
/// eigendecomposition of T.
class TridiagonalExponential {
 public:
  explicit TridiagonalExponential(const RationalExponential& rational);

  /// `off_diagonal` has at least diagonal.size() - 1 entries.
  double operator()(std::span<const double> diagonal, std::span<const double> off_diagonal,
                    double scale) const;

  /// Bound on the error, `norm` bounding |T|: of the approximation, and of
  /// rounding, which the resolvents amplify no further than by their norms.
  double error_bound(double scale, double norm) const;

 private:
  static constexpr std::size_t kLanes = 8;  // all terms at once, padded by zero ones
  using Lanes = std::array<double, kLanes>;

  Lanes shift_real_, shift_imag_, residue_real_, residue_imag_;
  double constant_;
  double approximation_error_;
  double rounding_constant_ = 0.0;  // sum of |residue| |resolvent|
  double rounding_slope_ = 0.0;     // sum of |residue| |resolvent|^2
};

}  // namespace isotherm::spectral::detail
