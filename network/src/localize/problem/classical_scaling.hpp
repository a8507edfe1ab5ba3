#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace isotherm::network::detail {

/// Eigenpairs of the inner products of points about their centre, from their squared
/// distances (n x n): -J D J / 2 with J = I - 11'/n (W. Torgerson, "Multidimensional
/// scaling", 1952). The points' coordinates are the last eigenvectors times the roots of
/// their values. O(n^3)
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> classical_scaling(const Eigen::MatrixXd& squared);

}  // namespace isotherm::network::detail
