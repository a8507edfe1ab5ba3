#pragma once

#include <vector>

#include "distributed/graph/matrices.hpp"

namespace isotherm::spectral::distributed::detail {

/// A Laplacian that is positive definite because one vertex of each component, the one of
/// largest degree, has the potential 0: its row and column are those of a diagonal matrix.
class Grounded {
 public:
  explicit Grounded(const LaplacianMatrix& laplacian);

  Mat get() const noexcept { return matrix_.get(); }

  /// Sets the entries of grounded vertices to 0.
  void ground(Vec x) const;

  /// Adds to each component's entries what makes that of its grounded vertex 0.
  void shift_to_ground(Vec x) const;

 private:
  const Graph::State& graph_;
  std::vector<std::size_t> rows_;  // of this rank, counted there
  MatHandle matrix_;
};

}  // namespace isotherm::spectral::distributed::detail
