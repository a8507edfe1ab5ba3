#include "isotherm/spectral/eigen/embed.hpp"

#include <algorithm>
#include <utility>

#include "eigen/embedding_from_pairs.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/spectral/eigen/embedding.hpp"

namespace isotherm::spectral {
namespace {

Eigen::MatrixXd coordinates(const EigenDecomposition& eigen, const EmbedOptions& options) {
  switch (options.method) {
    case Embedding::commute_time:
      return commute_time_embedding(eigen);
    case Embedding::heat:
      return heat_embedding(eigen, options.scale);
    case Embedding::eigenmaps:
      return laplacian_eigenmap(eigen);
  }
  throw InvalidArgument("method", "is not an embedding");
}

// How many of the first `wanted` vectors are of a value that more of them have.
Index interchangeable(const VectorBounds& vectors, Index wanted) {
  if (static_cast<Index>(vectors.group.size()) <= wanted) return 0;
  return std::max<Index>(0, wanted - vectors.group[static_cast<std::size_t>(wanted)]);
}

void shorten(EigenDecomposition& eigen, VectorBounds& vectors, Index count) {
  count = std::min(count, eigen.count());
  eigen.values.conservativeResize(count);
  eigen.vectors.conservativeResize(Eigen::NoChange, count);
  eigen.residuals.conservativeResize(count);
  eigen.bounds.conservativeResize(count);
  vectors.sines.conservativeResize(count);
  vectors.group.resize(static_cast<std::size_t>(count));
}

}  // namespace

void EmbedOptions::validate() const { require_fields_in_range(*this); }

namespace detail {

EmbedResult embed(std::int64_t vertex_count, std::int64_t component_count,
                  const EmbedOptions& options, const FindEigenpairs& find) {
  options.validate();
  EmbedResult result;
  result.components = static_cast<Index>(component_count);
  // Heat tells components apart by the null space, in which one component has one point.
  const bool null_vectors = options.method == Embedding::heat && component_count > 1;
  result.available = static_cast<Index>(vertex_count - (null_vectors ? 0 : component_count));
  const auto wanted = static_cast<Index>(
      std::clamp<std::int64_t>(options.dimensions, 1, std::max<Index>(1, result.available)));
  // The next value tells whether the last vector stands alone.
  const bool complete = result.available <= wanted;
  EigenOptions eigen_options;
  eigen_options.count = complete ? wanted : wanted + 1;
  eigen_options.null_vectors = null_vectors;
  result.eigen = find(eigen_options);
  result.vectors = vector_bounds(result.eigen, complete);
  if (result.eigen.null_count <= wanted) {
    result.interchangeable = interchangeable(result.vectors, wanted);
  }
  shorten(result.eigen, result.vectors, wanted);
  result.rows = coordinates(result.eigen, options);
  return result;
}

}  // namespace detail

EmbedResult embed(const WeightedGraph& graph, const EmbedOptions& options,
                  const ProgressCallback& progress) {
  options.validate();
  const Laplacian laplacian(graph, options.laplacian);
  return detail::embed(laplacian.size(), laplacian.components().count, options,
                       [&](EigenOptions eigen_options) {
                         eigen_options.progress = progress;
                         return smallest_eigenpairs(laplacian, eigen_options);
                       });
}

}  // namespace isotherm::spectral
