#pragma once

#include "isotherm/spectral/distributed.hpp"

namespace isotherm::spectral::distributed::detail {

/// Eigenpairs with the solver that found them, never `automatic`.
struct SolvedPairs {
  EigenDecomposition eigen;
  EigenSolver solver = EigenSolver::shift_invert;
};

SolvedPairs solve_pairs(const Graph& graph, LaplacianKind kind, const EigenOptions& options,
                        const SolverOptions& solver);

}  // namespace isotherm::spectral::distributed::detail
