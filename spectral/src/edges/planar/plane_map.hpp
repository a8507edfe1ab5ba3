#pragma once

#include <span>
#include <vector>

#include "edges/planar/planarity.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// The faces of a planar graph's drawing, and how many of its edges a curve between two
/// vertices has to cross: their distance in the dual graph.
///
/// Unless the graph is three-connected it has several drawings; distances are those in the one
/// that embed_in_plane() finds.
class PlaneMap {
 public:
  /// Draws the edges marked by `chosen`. O(n + m log d).
  /// @throws InvalidArgument unless they form a planar graph.
  PlaneMap(const WeightedGraph& graph, const std::vector<bool>& chosen);

  /// Fewest drawn edges that a curve from one vertex to another crosses, `most` + 1 if
  /// they are more; 0 where no drawn edges join the two. O(m) for large `most`.
  int crossings(Index from, Index to, int most);

  /// The edges that such a curve crosses, the last first.
  std::vector<Index> crossed_edges(Index from, Index to);

  /// Half-edges around the face on one side of a half-edge.
  std::span<const HalfEdge> face_beside(HalfEdge half) const { return face(face_of_[half]); }

  Index face_count() const { return static_cast<Index>(starts_.size()) - 1; }

 private:
  static constexpr Index kNone = -1;

  std::span<const HalfEdge> face(Index id) const {
    return {around_.data() + starts_[id], around_.data() + starts_[id + 1]};
  }
  Index search(Index from, Index to, int most);

  const WeightedGraph* graph_;
  std::vector<Index> face_of_;       // of a half-edge
  std::vector<HalfEdge> around_;     // half-edges, face by face
  std::vector<std::size_t> starts_;  // of each face in around_
  // Of a face: the last search that saw it, and that had it as a goal; the half-edge that the
  // search came across, and after how many crossings.
  std::vector<Index> seen_by_, goal_of_;
  std::vector<HalfEdge> entered_;
  std::vector<int> distance_;
  std::vector<Index> queue_;
  Index searches_ = 0;
};

}  // namespace isotherm::spectral::detail
