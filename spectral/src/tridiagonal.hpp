#pragma once

#include <span>
#include <vector>

namespace isotherm::spectral::detail {

/// Nodes and weights of the quadrature rule that belongs to a symmetric
/// tridiagonal (Jacobi) matrix: its eigenvalues, and the squared first
/// components of its unit eigenvectors (Golub and Welsch 1969).
struct QuadratureRule {
  std::vector<double> nodes;
  std::vector<double> weights;
  std::vector<double> scratch;  ///< kept so that repeated use does not allocate
};

/// Overwrites `rule`. `diagonal` has m entries, `off_diagonal` m - 1. O(m^2),
/// by implicit QL with Wilkinson shifts on the first row of the eigenvectors.
/// @throws NumericalError if an eigenvalue does not converge.
void gauss_quadrature(std::span<const double> diagonal, std::span<const double> off_diagonal,
                      QuadratureRule& rule);

}  // namespace isotherm::spectral::detail
