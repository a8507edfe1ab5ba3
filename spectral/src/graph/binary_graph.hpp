#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "isotherm/base/text_reader.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"

/// The compact form of a graph: a head, the number of every vertex, then every edge. All numbers
/// are little-endian.
namespace isotherm::spectral::detail {

constexpr std::string_view kBinaryGraph = "ISOGRAPH";

struct BinaryHead {
  char magic[8];
  std::uint32_t version = 1;
  std::uint32_t reserved = 0;
  std::uint64_t vertex_count = 0;
  std::uint64_t edge_count = 0;
};
static_assert(sizeof(BinaryHead) == 32);

/// Its vertices are positions in the list of numbers.
struct BinaryEdge {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  double weight = 1.0;
};
static_assert(sizeof(BinaryEdge) == 16);

/// Where the parts of a file begin and end, in bytes.
struct BinaryLayout {
  std::uint64_t ids = 0;
  std::uint64_t edges = 0;
  std::uint64_t end = 0;
};

/// @throws ParseError naming `path` if the head is of no file of this form and version, or claims
///   more than a graph may have
BinaryLayout binary_layout(const BinaryHead& head, const std::string& path);

/// @throws ParseError unless these numbers, which follow `before` others that end with `last`,
///   ascend
void check_ids(std::span<const std::uint64_t> ids, std::uint64_t before, std::uint64_t last,
               const std::string& path);

/// @throws ParseError naming the number of the first edge, `before` plus its place, that joins no
///   vertices or has no usable weight
void check_edges(std::span<const BinaryEdge> edges, std::uint64_t before,
                 std::uint64_t vertex_count, const std::string& path);

/// @throws ParseError, FileError
GraphFile read_binary_graph(TextReader& reader, ReadReport report);

}  // namespace isotherm::spectral::detail
