#pragma once

#include <Eigen/Core>

#include "isotherm/spectral/eigen/eigen_decomposition.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace isotherm::spectral {

/// The heat kernel H(t) = exp(-tL) in spectral form (paper eq. 4 to 9).
///
/// From all eigenpairs it is exact to rounding: the oracle for everything that
/// avoids forming it. From k < n pairs it is the truncated kernel, and
/// remainder() bounds what is missing.
class HeatKernel {
 public:
  /// All pairs by the dense solver: O(n^3) time, O(n^2) memory.
  explicit HeatKernel(const Laplacian& laplacian);

  /// The kernel truncated to the given pairs.
  explicit HeatKernel(EigenDecomposition eigen);

  const EigenDecomposition& eigen() const noexcept { return eigen_; }

  /// H_ij(t). O(k).
  double entry(Index row, Index column, double scale) const;

  /// H(t) as a dense matrix. O(n^2 k).
  Eigen::MatrixXd matrix(double scale) const;

  /// The heat kernel signature H_vv(t) of every vertex (Sun, Ovsjanikov and
  /// Guibas 2009), n entries.
  Eigen::VectorXd signature(double scale) const;

  /// Squared heat distance H_ii + H_jj - 2 H_ij (paper eq. 9). O(k).
  double distance(VertexPair pair, double scale) const;

  /// Upper bound on what truncation hides of a distance:
  /// exp(-t lambda_k) (2 - sum_l (u_li - u_lj)^2); 0 with all pairs.
  double remainder(VertexPair pair, double scale) const;

 private:
  EigenDecomposition eigen_;
};

}  // namespace isotherm::spectral
