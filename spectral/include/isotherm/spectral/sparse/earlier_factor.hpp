#pragma once

#include <optional>

#include <Eigen/Core>

#include "isotherm/spectral/sparse/block_cholesky.hpp"

namespace isotherm::spectral {

/// x with A x = b to two digits, in the norm of A, where A was factorised last with other values
/// that were not far from these: conjugate gradients preconditioned by that factor (Golub and Van
/// Loan, section 11.5). Takes a few solutions by the factor instead of a factorisation, or gives
/// nothing once it is seen that it would take many.
/// @throws NumericalError where A was never factorised
std::optional<Eigen::VectorXd> solve_by_earlier_factor(const BlockCholesky& matrix,
                                                       const Eigen::VectorXd& rhs);

}  // namespace isotherm::spectral
