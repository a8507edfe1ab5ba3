#include <utility>

#include "distributed/eigen/smallest_eigenpairs.hpp"
#include "eigen/embedding_from_pairs.hpp"

namespace isotherm::spectral::distributed {

EmbedResult embed(const Graph& graph, const EmbedOptions& options, const SolverOptions& solver,
                  const ProgressCallback& progress) {
  EmbedResult result;
  static_cast<spectral::EmbedResult&>(result) = spectral::detail::embed(
      graph.vertex_count(), graph.component_count(), options, [&](EigenOptions eigen_options) {
        eigen_options.progress = progress;
        auto solved = detail::solve_pairs(graph, options.laplacian, eigen_options, solver);
        result.solver = solved.solver;
        return std::move(solved.eigen);
      });
  return result;
}

}  // namespace isotherm::spectral::distributed
