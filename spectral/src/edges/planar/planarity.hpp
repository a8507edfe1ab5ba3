#pragma once

#include <optional>
#include <vector>

#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// A direction along an edge: 2 e leads from the edge's `from` to its `to`, 2 e + 1 back.
using HalfEdge = Index;

constexpr HalfEdge opposite(HalfEdge half) { return half ^ 1; }

/// A drawing without crossings, up to continuous change.
struct PlanarEmbedding {
  /// By half-edge: the next one clockwise around the vertex that it leaves; kNone for
  /// edges that are not drawn.
  std::vector<HalfEdge> clockwise;

  static constexpr HalfEdge kNone = -1;
};

/// Whether the edges marked by `chosen` can be drawn in the plane without crossings.
///
/// The left-right test of H. de Fraysseix and P. Rosenstiehl as given by U. Brandes, *The
/// left-right planarity test*, 2009. Parallel edges are allowed, self-loops are ignored.
/// O(n + m log d) for degrees of up to d; a tenth of the time of Boost.Graph's test by Boyer and
/// Myrvold (docs/results/libraries.md).
bool is_planar(const WeightedGraph& graph, const std::vector<bool>& chosen);

/// A drawing of the edges marked by `chosen`, if there is one; costs like is_planar().
std::optional<PlanarEmbedding> embed_in_plane(const WeightedGraph& graph,
                                              const std::vector<bool>& chosen);

}  // namespace isotherm::spectral::detail
