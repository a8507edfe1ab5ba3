#include "edges/planar/plane_map.hpp"

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::detail {

PlaneMap::PlaneMap(const WeightedGraph& graph, const std::vector<bool>& chosen) : graph_(&graph) {
  const auto drawing = embed_in_plane(graph, chosen);
  if (!drawing) throw InvalidArgument("chosen", "is no planar graph");
  const auto& clockwise = drawing->clockwise;
  face_of_.assign(clockwise.size(), kNone);
  starts_.push_back(0);
  for (std::size_t first = 0; first < clockwise.size(); ++first) {
    if (clockwise[first] == PlanarEmbedding::kNone || face_of_[first] != kNone) continue;
    const Index id = face_count();
    auto half = static_cast<HalfEdge>(first);
    do {
      face_of_[half] = id;
      around_.push_back(half);
      half = clockwise[opposite(half)];
    } while (half != static_cast<HalfEdge>(first));
    starts_.push_back(around_.size());
  }
  seen_by_.assign(face_count(), 0);
  goal_of_.assign(face_count(), 0);
  entered_.resize(face_count());
  distance_.resize(face_count());
}

// Breadth first through faces, from those around one vertex; the first face around the
// other that it comes to, or kNone.
Index PlaneMap::search(Index from, Index to, int most) {
  ++searches_;
  queue_.clear();
  const auto for_faces_around = [this](Index vertex, auto act) {
    for (const auto& [other, edge] : graph_->neighbours(vertex)) {
      const Index id = face_of_[2 * edge + (graph_->edge(edge).from == vertex ? 0 : 1)];
      if (id != kNone) act(id);
    }
  };
  const auto reach = [this](Index id, HalfEdge across, int distance) {
    if (seen_by_[id] == searches_) return;
    seen_by_[id] = searches_;
    entered_[id] = across;
    distance_[id] = distance;
    queue_.push_back(id);
  };
  for_faces_around(to, [this](Index id) { goal_of_[id] = searches_; });
  for_faces_around(from, [&](Index id) { reach(id, PlanarEmbedding::kNone, 0); });
  for (std::size_t k = 0; k < queue_.size(); ++k) {
    const Index id = queue_[k];
    if (goal_of_[id] == searches_) return id;
    if (distance_[id] == most) continue;
    for (const HalfEdge half : face(id)) {
      reach(face_of_[opposite(half)], half, distance_[id] + 1);
    }
  }
  return kNone;
}

int PlaneMap::crossings(Index from, Index to, int most) {
  const Index goal = search(from, to, most);
  if (goal != kNone) return distance_[goal];
  // A search that was not cut short has seen all faces of the component.
  const bool cut_short = !queue_.empty() && distance_[queue_.back()] == most;
  return cut_short ? most + 1 : 0;
}

std::vector<Index> PlaneMap::crossed_edges(Index from, Index to) {
  std::vector<Index> crossed;
  Index id = search(from, to, static_cast<int>(face_count()));
  while (id != kNone && entered_[id] != PlanarEmbedding::kNone) {
    crossed.push_back(entered_[id] / 2);
    id = face_of_[entered_[id]];
  }
  return crossed;
}

}  // namespace isotherm::spectral::detail
