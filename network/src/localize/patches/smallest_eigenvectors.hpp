#pragma once

#include <Eigen/Core>

#include "isotherm/spectral/sparse/block_cholesky.hpp"

namespace isotherm::network::detail {

/// Orthonormal vectors, n x count, that span the eigenspace of the `count` smallest
/// eigenvalues of a positive semi-definite matrix, by inverse iteration on a
/// subspace with a few vectors to spare, since they may belong to one multiple eigenvalue
/// (docs/results/libraries.md). Factorises the matrix, a little shifted.
/// @throws NumericalError if it breaks down.
Eigen::MatrixXd smallest_eigenvectors(spectral::BlockCholesky& matrix, int count);

}  // namespace isotherm::network::detail
