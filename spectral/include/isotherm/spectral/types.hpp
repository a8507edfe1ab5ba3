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

}  // namespace isotherm::spectral
