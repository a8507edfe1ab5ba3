#pragma once

#include "distributed/eigen/pairs.hpp"
#include "isotherm/spectral/eigen/eigen_decomposition.hpp"

/// Eigenvectors that were found, with their values.
namespace isotherm::spectral::distributed::detail {

/// In ascending order of values, which are Rayleigh quotients summed over edges.
struct Pairs {
  std::vector<double> values;
  Vectors vectors;

  std::int64_t count() const { return static_cast<std::int64_t>(values.size()); }
  std::int64_t below(double bound) const;
};

/// `pairs` and the vectors in `more`, of which the `count` of smallest values stay.
void merge(const LaplacianMatrix& laplacian, Mat incidence, Pairs& pairs, Vectors more,
           std::int64_t count);

/// |L u - lambda u| of one pair.
double residual(const LaplacianMatrix& laplacian, Vec vector, double value);

/// How far eigenvalues may be off through rounding of the matrix itself.
double rounding(const LaplacianMatrix& laplacian);

/// Makes the entry of largest magnitude of each vector (the first of equals) positive, and fills
/// `result` with the pairs behind its null pairs: values, residuals, bounds, rows of this rank's
/// block, orthogonality; and the status where these say that something has not converged.
void assess(const LaplacianMatrix& laplacian, const NullSpace& null_space, Pairs& pairs,
            double tolerance, EigenDecomposition& result);

}  // namespace isotherm::spectral::distributed::detail
