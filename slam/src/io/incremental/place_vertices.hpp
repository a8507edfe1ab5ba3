#pragma once

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::slam::detail {

/// Gives poses to the vertices that have none: breadth first along the constraints, starting from
/// all that are `placed`; what none of them leads to starts at the origin.
/// @param tell called with each vertex, and the constraint that placed it, if any
template <class Pose, class Tell>
void place_vertices(PoseGraph<Pose>& graph, std::vector<bool> placed, const Tell& tell) {
  std::vector<spectral::WeightedEdge> edges;
  edges.reserve(graph.constraints.size());
  for (const auto& constraint : graph.constraints) {
    edges.push_back({constraint.from, constraint.to, 1.0});
  }
  const spectral::WeightedGraph adjacency(graph.vertex_count(), std::move(edges));
  std::vector<Index> queue;
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    if (placed[v]) queue.push_back(v);
  }
  const auto place = [&](Index vertex, const Pose& pose, std::optional<Index> edge) {
    graph.poses[vertex] = pose;
    placed[vertex] = true;
    queue.push_back(vertex);
    tell(vertex, edge);
  };
  std::size_t head = 0;
  for (Index start = 0;;) {
    for (; head < queue.size(); ++head) {
      const Index known = queue[head];
      for (const auto& [neighbour, edge] : adjacency.neighbours(known)) {
        if (placed[neighbour]) continue;
        const auto& [from, T] =
            std::tie(graph.constraints[edge].from, graph.constraints[edge].T_from_to);
        place(neighbour, graph.poses[known] * (from == known ? T : T.inverse()), edge);
      }
    }
    while (start < graph.vertex_count() && placed[start]) ++start;
    if (start == graph.vertex_count()) return;
    place(start, Pose(), std::nullopt);
  }
}

}  // namespace isotherm::slam::detail
