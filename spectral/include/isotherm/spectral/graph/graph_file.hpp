#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral {

/// A weighted graph as a file has it.
struct GraphFile {
  WeightedGraph graph;             ///< edge k is the k-th edge of the file
  std::vector<std::uint64_t> ids;  ///< the file's number of each vertex, ascending
  ReadReport report;
};

/// Reads a weighted graph, telling the format by its content: what write_binary_graph() wrote, an
/// edge list
/// (`from to [weight]` a row, separated by commas or blanks, with or without
/// column names; weights default to 1) or a symmetric sparse matrix in
/// MatrixMarket coordinate format (entry (i, j) is the weight of edge {i, j};
/// a matrix stored in full must be symmetric; the diagonal is left out).
///
/// O(m log m); memory is proportional to what is in the file, whatever ids and
/// sizes it claims.
/// @throws FileError if the file cannot be read, ParseError if it is malformed or
///   empty, a weight is not finite and positive, or `options.strict` is set and a
///   repair is needed.
GraphFile read_graph(const std::string& path, const ReadOptions& options = {});

/// The same from a reader that stands at the start of its input.
GraphFile read_graph(TextReader& reader, const ReadOptions& options = {});

/// Makes both directions of an edge one edge, at the place of the first, with a note in the report:
/// lists of directed edges have each twice. Edges that are repeated in the same direction stay.
/// Where the weights differ, the edge has their mean, which is a repair. O(m log m).
/// @throws ParseError for a repair if `options.strict` is set
void merge_directions(GraphFile& file, const ReadOptions& options = {});

/// Writes `from,to,weight` rows with column names. Vertices without an edge do
/// not appear.
/// @throws FileError if the file cannot be written, InvalidArgument unless `ids`
///   has one entry a vertex.
void write_edge_csv(const std::string& path, const WeightedGraph& graph,
                    const std::vector<std::uint64_t>& ids);

/// Writes the lower triangle of the weight matrix in MatrixMarket format, rows
/// numbered from 1 in order of position; parallel edges are added up.
/// @throws FileError if the file cannot be written.
void write_matrix_market(const std::string& path, const WeightedGraph& graph);

/// Writes the compact form of a graph (docs/formats.md): half the size of text, read without
/// parsing, and any part of it by itself. All edges and vertices are kept as they are.
/// @throws FileError if the file cannot be written, InvalidArgument unless `ids` has one entry a
///   vertex, in ascending order.
void write_binary_graph(const std::string& path, const WeightedGraph& graph,
                        const std::vector<std::uint64_t>& ids);

}  // namespace isotherm::spectral
