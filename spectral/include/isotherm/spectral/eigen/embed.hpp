#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include <Eigen/Core>

#include "isotherm/base/options.hpp"
#include "isotherm/base/progress.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/spectral/eigen/eigen_decomposition.hpp"
#include "isotherm/spectral/eigen/vector_bounds.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral {

/// Which of the coordinates of embedding.hpp.
enum class Embedding { commute_time, heat, eigenmaps };

constexpr std::array<EnumName<Embedding>, 3> enum_names(Embedding) {
  return {{{Embedding::commute_time, "commute-time"},
           {Embedding::heat, "heat"},
           {Embedding::eigenmaps, "eigenmaps"}}};
}

struct EmbedOptions {
  Embedding method = Embedding::commute_time;
  /// Columns, >= 1. Null eigenvectors have none, but for heat, if there are several.
  std::int64_t dimensions = 2;
  double scale = 1.0;  ///< diffusion time, for heat; finite, >= 0
  LaplacianKind laplacian = LaplacianKind::combinatorial;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, EmbedOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("method", options.method, "coordinates to compute");
  visit("dimensions", options.dimensions,
        "number of coordinates; for heat those that tell components apart come first",
        closed(1, 1e6));
  visit("scale", options.scale, "heat: diffusion time", closed(0, 1e12));
  visit("laplacian", options.laplacian, "matrix whose eigenvectors are used");
}

/// Coordinates with the eigenpairs that they were made from.
struct EmbedResult {
  Eigen::MatrixXd rows;  ///< vertices x coordinates; fewer than asked for if there are no more
  EigenDecomposition eigen;
  VectorBounds vectors;
  Index components = 0;  ///< of the graph
  Index available = 0;   ///< coordinates that the graph has
  /// Coordinates at the end whose eigenvalues cannot be told from those of the next, left out.
  Index interchangeable = 0;
};

/// Gives each vertex `options.dimensions` coordinates. Of a graph in several components, heat
/// gives first those that tell the components apart, one a component.
/// @throws InvalidArgument, NumericalError, Cancelled
EmbedResult embed(const WeightedGraph& graph, const EmbedOptions& options = {},
                  const ProgressCallback& progress = {});

}  // namespace isotherm::spectral
