#include "distributed/graph/build_graph.hpp"

#include <algorithm>
#include <utility>

namespace isotherm::spectral::distributed::detail {
namespace {

/// Positions of this rank's rows.
std::vector<Index> positions_of_rows(const Comm& comm, const Blocks& positions, const Rows& rows) {
  std::vector<VertexPair> pairs;  // row and position
  auto position = static_cast<Index>(positions.begin(comm.rank));
  for (const Index row : rows.of_block) pairs.push_back({row, position++});
  const auto mine = exchange(comm, std::span<const VertexPair>(pairs), [&](const VertexPair& pair) {
                      return rows.blocks.owner(pair.from);
                    }).items;
  const auto begin = static_cast<Index>(rows.blocks.begin(comm.rank));
  std::vector<Index> result(mine.size());
  for (const auto& [row, at] : mine) result[row - begin] = at;
  return result;
}

/// The edges in rows in place of positions, each with the rank of its first end.
std::vector<RowEdge> in_rows(const Comm& comm, const Blocks& positions, const Rows& rows,
                             std::vector<PlacedEdge> edges) {
  std::vector<Index> ends;
  ends.reserve(2 * edges.size());
  for (const auto& edge : edges) {
    ends.push_back(edge.from);
    ends.push_back(edge.to);
  }
  ends =
      look_up(comm, positions, std::span<const Index>(rows.of_block), std::span<const Index>(ends));
  std::vector<RowEdge> placed;
  placed.reserve(edges.size());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    placed.push_back({ends[2 * k], ends[2 * k + 1], edges[k].weight, edges[k].place});
  }
  std::vector<PlacedEdge>().swap(edges);
  auto mine = exchange(comm, std::span<const RowEdge>(placed), [&](const RowEdge& edge) {
                return rows.blocks.owner(edge.from);
              }).items;
  std::sort(mine.begin(), mine.end(),
            [](const RowEdge& a, const RowEdge& b) { return a.place < b.place; });
  return mine;
}

/// Fills what the edges, each with its rank, say of the graph.
void follow_from_edges(Graph::State& graph) {
  const auto& comm = graph.comm();
  graph.edge_count = sum(comm, static_cast<std::int64_t>(graph.edges.size()));
  std::int64_t crossing = 0;
  for (const auto& edge : graph.edges) crossing += graph.owns(edge.to) ? 0 : 1;
  const auto total = std::max<std::int64_t>(1, graph.edge_count);
  graph.cut = static_cast<double>(sum(comm, crossing)) / static_cast<double>(total);
  assemble_laplacian(graph);
  graph.components = find_components(comm, graph.rows, graph.edges, graph.position_of);
}

}  // namespace

std::unique_ptr<Graph::State> build_graph(const Session& session, EdgePart part, Twice twice,
                                          const GraphOptions& options) {
  const auto& comm = session.state().comm;
  auto graph = std::make_unique<Graph::State>();
  graph->session = &session;
  graph->report = std::move(part.report);
  graph->places = Blocks::of_sizes(comm, static_cast<std::int64_t>(part.edges.size()));
  auto edges = bring_together(comm, part, graph->places);
  std::vector<WeightedEdge>().swap(part.edges);
  if (twice == Twice::counts_once) {
    merge_directions(comm, {.strict = options.strict}, edges, graph->report);
  }
  graph->blocks = part.blocks;
  graph->ids = std::move(part.ids);
  auto rows = partition(comm, graph->blocks, edges, options.partitioner);
  graph->rows = rows.blocks;
  graph->position_of = positions_of_rows(comm, graph->blocks, rows);
  graph->edges = in_rows(comm, graph->blocks, rows, std::move(edges));
  graph->row_of = std::move(rows.of_block);

  follow_from_edges(*graph);
  return graph;
}

std::unique_ptr<Graph::State> filter_edges(const Graph::State& graph,
                                           const std::vector<char>& keep) {
  auto left = std::make_unique<Graph::State>();
  left->session = graph.session;
  left->report = graph.report;
  left->blocks = graph.blocks;
  left->ids = graph.ids;
  left->row_of = graph.row_of;
  left->rows = graph.rows;
  left->position_of = graph.position_of;
  left->places = graph.places;
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    if (keep[k] != 0) left->edges.push_back(graph.edges[k]);
  }
  follow_from_edges(*left);
  return left;
}

}  // namespace isotherm::spectral::distributed::detail
