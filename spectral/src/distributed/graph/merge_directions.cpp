#include <algorithm>
#include <tuple>

#include "distributed/graph/build_graph.hpp"
#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

auto ends(const PlacedEdge& edge) { return std::minmax(edge.from, edge.to); }

/// What became of the edges of a rank.
struct Merged {
  std::vector<PlacedEdge> edges;
  std::int64_t twice = 0;      // edges that repeat one in the other direction
  std::int64_t differing = 0;  // of these, with another weight
};

/// `edges` are in order of their ends, then of the file.
Merged merge(std::span<const PlacedEdge> edges) {
  Merged merged;
  std::vector<std::size_t> waiting;  // edges of one direction without their other
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto& edge = edges[k];
    if (k > 0 && ends(edges[k - 1]) != ends(edge)) waiting.clear();
    const bool alone = waiting.empty() || merged.edges[waiting.back()].from == edge.from;
    if (edge.from == edge.to || alone) {
      if (edge.from != edge.to) waiting.push_back(merged.edges.size());
      merged.edges.push_back(edge);
      continue;
    }
    auto& weight = merged.edges[waiting.back()].weight;
    waiting.pop_back();
    ++merged.twice;
    if (weight == edge.weight) continue;
    ++merged.differing;
    weight = 0.5 * weight + 0.5 * edge.weight;
  }
  return merged;
}

}  // namespace

std::vector<PlacedEdge> bring_together(const Comm& comm, const EdgePart& part,
                                       const Blocks& places) {
  std::vector<PlacedEdge> placed;
  placed.reserve(part.edges.size());
  auto place = places.begin(comm.rank);
  for (const auto& edge : part.edges) {
    placed.push_back({edge.from, edge.to, edge.weight, place++});
  }
  auto edges = exchange(comm, std::span<const PlacedEdge>(placed), [&](const PlacedEdge& edge) {
                 return part.blocks.owner(std::min(edge.from, edge.to));
               }).items;
  std::sort(edges.begin(), edges.end(), [](const PlacedEdge& a, const PlacedEdge& b) {
    return std::tuple(ends(a), a.place) < std::tuple(ends(b), b.place);
  });
  return edges;
}

void merge_directions(const Comm& comm, const ReadOptions& options, std::vector<PlacedEdge>& edges,
                      ReadReport& report) {
  auto merged = merge(edges);
  const auto twice = sum(comm, merged.twice), differing = sum(comm, merged.differing);
  if (differing > 0 && options.strict) {
    throw ParseError(
        {report.path, 0, 0}, "",
        std::to_string(differing) + " edges have another weight in the other direction");
  }
  if (differing > 0) {
    report.repairs["edge with two weights"] = static_cast<std::uint64_t>(differing);
  }
  if (twice > 0) report.notes["edge in both directions"] = static_cast<std::uint64_t>(twice);
  edges = std::move(merged.edges);
}

}  // namespace isotherm::spectral::distributed::detail
