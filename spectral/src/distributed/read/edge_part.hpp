#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "distributed/support/comm.hpp"
#include "graph/edge_rows.hpp"
#include "isotherm/base/read_report.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::distributed::detail {

/// One rank's part of a file. The ends of edges are positions.
struct EdgePart {
  std::vector<WeightedEdge> edges;
  Blocks blocks;                   ///< of positions
  std::vector<std::uint64_t> ids;  ///< the file's numbers of this rank's block, ascending
  ReadReport report;               ///< the same on every rank
};

/// Each rank reads its part, by content: binary, MatrixMarket, g2o or an edge list.
/// @throws what Graph::read() does, the same on every rank
EdgePart read_edge_part(const Comm& comm, const std::string& path, const ReadOptions& options);

/// Positions for the numbers of vertices in `edges` and `others`, in ascending order over all
/// ranks. Takes what the edges hold, to save memory. @throws ParseError for too many vertices
EdgePart number_vertices(const Comm& comm, std::vector<spectral::detail::FileEdge> edges,
                         std::vector<std::uint64_t> others, const std::string& path);

}  // namespace isotherm::spectral::distributed::detail
