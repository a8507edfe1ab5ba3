#pragma once

#include <Eigen/Core>

#include "isotherm/spectral/eigen/eigen_decomposition.hpp"

/// Coordinates for the vertices of a graph from its Laplacian's eigenpairs.
/// Every function returns one row a vertex.
namespace isotherm::spectral {

/// Laplacian eigenmaps (Belkin and Niyogi 2003): the eigenvectors that are not
/// null, n x (k - null_count).
Eigen::MatrixXd laplacian_eigenmap(const EigenDecomposition& eigen);

/// The commute-time embedding X = Lambda^(-1/2) U' over the pairs that are not
/// null (paper eq. 3), transposed: n x (k - null_count). With all pairs, squared
/// distances between rows of one component are effective resistances; times
/// the graph's volume, commute times. A value that rounding made 0 counts as its bound.
Eigen::MatrixXd commute_time_embedding(const EigenDecomposition& eigen);

/// The heat-kernel embedding X = exp(-t Lambda / 2) U' (paper eq. 8),
/// transposed: n x k. With all pairs, squared distances between rows are heat
/// distances D(t).
/// @throws InvalidArgument unless `scale` is finite and >= 0.
Eigen::MatrixXd heat_embedding(const EigenDecomposition& eigen, double scale);

}  // namespace isotherm::spectral
