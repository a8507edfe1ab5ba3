#pragma once

#include <span>
#include <vector>

#include "distributed/graph/graph_state.hpp"
#include "distributed/read/edge_part.hpp"

namespace isotherm::spectral::distributed::detail {

/// An edge between positions, with its place in the file.
struct PlacedEdge {
  Index from = 0;
  Index to = 0;
  double weight = 0.0;
  std::int64_t place = 0;
};

/// The edges of all parts, each with the rank whose block its smaller end is in; in order of their
/// ends, then of the file.
std::vector<PlacedEdge> bring_together(const Comm& comm, const EdgePart& part,
                                       const Blocks& places);

/// Makes both directions of an edge one, as spectral::merge_directions() does for a whole file.
/// Counts in `report`, the same on all ranks.
/// @throws ParseError for a repair if `options.strict` is set
void merge_directions(const Comm& comm, const ReadOptions& options, std::vector<PlacedEdge>& edges,
                      ReadReport& report);

/// The row of each position of this rank's block, so that few edges lie between ranks.
struct Rows {
  std::vector<Index> of_block;
  Blocks blocks;
};
Rows partition(const Comm& comm, const Blocks& positions, std::span<const PlacedEdge> edges,
               Partitioner partitioner);

/// Fills laplacian, degrees and norm_bound from the edges. Sums are in order of the file, the same
/// for any number of ranks.
void assemble_laplacian(Graph::State& graph);

/// What a list says of an edge that it has from both ends.
enum class Twice { counts_once, counts_twice };

/// A graph of what was read.
std::unique_ptr<Graph::State> build_graph(const Session& session, EdgePart part, Twice twice,
                                          const GraphOptions& options);

/// The graph with only those of this rank's edges whose `keep` entry is not 0, on the same ranks.
std::unique_ptr<Graph::State> filter_edges(const Graph::State& graph,
                                           const std::vector<char>& keep);

}  // namespace isotherm::spectral::distributed::detail
