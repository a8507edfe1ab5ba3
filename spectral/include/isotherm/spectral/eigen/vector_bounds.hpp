#pragma once

#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/eigen/eigen_decomposition.hpp"
#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral {

/// How well the eigenvectors of a decomposition are known.
struct VectorBounds {
  /// Of each pair the first one whose value cannot be told from its own: closer than both
  /// bounds, or through others that are. Any turn of the vectors of such a group is as good as
  /// they are; null pairs are a group of their own.
  std::vector<Index> group;
  /// Of each vector the sine of its angle to the true eigenvectors of its group; 1 where nothing
  /// is known. 0 for null vectors, which are known exactly.
  Eigen::VectorXd sines;
};

/// By the residuals and the gaps between eigenvalues (C. Davis, W. M. Kahan, "The rotation of
/// eigenvectors by a perturbation III", 1970): |residual| / (distance to the next value that is
/// not of the group), everything off by its bound.
/// @param complete no eigenvalues lie beyond the last one; else of the last group nothing is
///   known, as it may go on. O(k)
VectorBounds vector_bounds(const EigenDecomposition& eigen, bool complete);

}  // namespace isotherm::spectral
