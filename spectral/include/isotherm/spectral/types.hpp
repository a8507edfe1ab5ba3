#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace isotherm::spectral {

/// Vertex and edge numbers, both counted from 0. 32 bits hold every graph that
/// fits a laptop and halve the memory of the sparse structures.
using Index = std::int32_t;

/// Column-major sparse matrix with 32-bit indices.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// An unordered pair of vertices.
struct VertexPair {
  Index from = 0;
  Index to = 0;
};

/// A number that is known to lie in [lower, upper]. `value` is in there too.
struct CertifiedValue {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;

  double width() const { return upper - lower; }
};

}  // namespace isotherm::spectral
