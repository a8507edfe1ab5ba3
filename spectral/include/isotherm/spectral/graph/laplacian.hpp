#pragma once

#include <array>

#include <Eigen/Core>

#include "isotherm/base/options.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral {

enum class LaplacianKind {
  combinatorial,  ///< L = D - W
  normalised,     ///< N = D^(-1/2) L D^(-1/2); rows of isolated vertices are zero
};

constexpr std::array<EnumName<LaplacianKind>, 2> enum_names(LaplacianKind) {
  return {
      {{LaplacianKind::combinatorial, "combinatorial"}, {LaplacianKind::normalised, "normalised"}}};
}

/// The Laplacian of a graph (paper eq. 1) as a sparse symmetric matrix, with
/// what else is known about it without an eigensolver: its components, hence
/// its null space, and a bound on its norm.
///
/// Parallel edges add up and self-loops vanish. The matrix is stored in full
/// (both triangles) and every diagonal entry is present.
class Laplacian {
 public:
  Laplacian() = default;

  /// O(n + m) time and memory, apart from sorting each column.
  explicit Laplacian(const WeightedGraph& graph, LaplacianKind kind = LaplacianKind::combinatorial);

  const SparseMatrix& matrix() const noexcept { return matrix_; }
  LaplacianKind kind() const noexcept { return kind_; }
  Index size() const noexcept { return static_cast<Index>(matrix_.rows()); }

  /// Weighted degrees of the graph, n entries.
  const Eigen::VectorXd& degrees() const noexcept { return degrees_; }

  const ConnectedComponents& components() const noexcept { return components_; }

  /// An upper bound on the largest eigenvalue, by Gershgorin's circles:
  /// twice the largest degree, or 2 for the normalised kind.
  double norm_bound() const noexcept { return norm_bound_; }

  /// n x components().count orthonormal basis of the null space: on each
  /// component a constant, or D^(1/2) times a constant for the normalised kind.
  SparseMatrix null_space() const;

 private:
  SparseMatrix matrix_;
  LaplacianKind kind_ = LaplacianKind::combinatorial;
  Eigen::VectorXd degrees_;
  ConnectedComponents components_;
  double norm_bound_ = 0.0;
};

}  // namespace isotherm::spectral
