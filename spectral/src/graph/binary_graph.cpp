#include "graph/binary_graph.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

#include "graph/edge_rows.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"

namespace isotherm::spectral {
namespace detail {
namespace {

static_assert(std::endian::native == std::endian::little, "files are read as they are");

// So many at a time: memory grows with what is in a file, not with what its head claims.
constexpr std::uint64_t kAtOnce = std::uint64_t{1} << 16;

[[noreturn]] void fail(const std::string& path, const std::string& problem) {
  throw ParseError({path, 0, 0}, "", problem);
}

template <class Item>
std::vector<Item> read_items(TextReader& reader, std::uint64_t count) {
  std::vector<Item> items;
  while (items.size() < count) {
    const auto begin = items.size();
    items.resize(begin + std::min<std::uint64_t>(kAtOnce, count - begin));
    const auto wanted = (items.size() - begin) * sizeof(Item);
    const std::span target(reinterpret_cast<char*>(items.data() + begin), wanted);
    if (reader.bytes(target) < wanted) fail(reader.path(), "ends before its last edge");
  }
  return items;
}

}  // namespace

BinaryLayout binary_layout(const BinaryHead& head, const std::string& path) {
  constexpr std::uint64_t kMostVertices = std::numeric_limits<Index>::max() - 1;
  constexpr std::uint64_t kMostEdges = std::uint64_t{1} << 48;
  if (std::string_view(head.magic, sizeof(head.magic)) != kBinaryGraph) {
    fail(path, "is no binary graph");
  }
  if (head.version != 1 || head.reserved != 0) {
    fail(path, "is of version " + std::to_string(head.version) + " of the format; expected 1");
  }
  if (head.vertex_count > kMostVertices) fail(path, "claims too many vertices");
  if (head.edge_count > kMostEdges) fail(path, "claims too many edges");
  BinaryLayout layout;
  layout.ids = sizeof(BinaryHead);
  layout.edges = layout.ids + head.vertex_count * sizeof(std::uint64_t);
  layout.end = layout.edges + head.edge_count * sizeof(BinaryEdge);
  return layout;
}

void check_ids(std::span<const std::uint64_t> ids, std::uint64_t before, std::uint64_t last,
               const std::string& path) {
  for (const auto id : ids) {
    if (before++ > 0 && id <= last) {
      fail(path, "vertex " + std::to_string(before - 1) + ": expected ascending numbers");
    }
    last = id;
  }
}

void check_edges(std::span<const BinaryEdge> edges, std::uint64_t before,
                 std::uint64_t vertex_count, const std::string& path) {
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto& [from, to, weight] = edges[k];
    const auto fail_here = [&, number = before + k](const std::string& problem) {
      fail(path, "edge " + std::to_string(number) + ": " + problem);
    };
    if (from >= vertex_count || to >= vertex_count) {
      fail_here("expected vertices below " + std::to_string(vertex_count));
    }
    if (!usable_weight(weight)) fail_here(kExpectedWeight);
  }
}

GraphFile read_binary_graph(TextReader& reader, ReadReport report) {
  const auto head = read_items<BinaryHead>(reader, 1).front();
  binary_layout(head, reader.path());
  if (head.edge_count > std::numeric_limits<Index>::max() / 2) {
    fail(reader.path(), "has more edges than one machine's graph may have");
  }
  GraphFile file;
  file.ids = read_items<std::uint64_t>(reader, head.vertex_count);
  check_ids(file.ids, 0, 0, reader.path());
  const auto raw = read_items<BinaryEdge>(reader, head.edge_count);
  check_edges(raw, 0, head.vertex_count, reader.path());
  char more = 0;
  if (reader.bytes({&more, 1}) > 0) fail(reader.path(), "goes on behind its last edge");
  std::vector<WeightedEdge> edges;
  edges.reserve(raw.size());
  for (const auto& [from, to, weight] : raw) {
    edges.push_back({static_cast<Index>(from), static_cast<Index>(to), weight});
  }
  file.graph = WeightedGraph(static_cast<Index>(head.vertex_count), std::move(edges));
  report.records["edge"] = raw.size();
  file.report = std::move(report);
  return file;
}

}  // namespace detail

void write_binary_graph(const std::string& path, const WeightedGraph& graph,
                        const std::vector<std::uint64_t>& ids) {
  if (ids.size() != static_cast<std::size_t>(graph.vertex_count())) {
    throw InvalidArgument("ids", "must have one entry a vertex");
  }
  if (std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) != ids.end()) {
    throw InvalidArgument("ids", "must ascend");
  }
  const auto write = [](OutputFile& file, const auto& items) {
    file.write({reinterpret_cast<const char*>(items.data()), items.size() * sizeof(items[0])});
  };
  detail::BinaryHead head;
  detail::kBinaryGraph.copy(head.magic, sizeof(head.magic));
  head.vertex_count = ids.size();
  head.edge_count = graph.edges().size();
  OutputFile file(path);
  write(file, std::span(&head, 1));
  std::vector<detail::BinaryEdge> some;
  for (std::size_t k = 0; k < ids.size(); k += detail::kAtOnce) {
    write(file, std::span(ids).subspan(k, std::min<std::size_t>(detail::kAtOnce, ids.size() - k)));
  }
  for (std::size_t k = 0; k < graph.edges().size(); ++k) {
    const auto& edge = graph.edges()[k];
    some.push_back(
        {static_cast<std::uint32_t>(edge.from), static_cast<std::uint32_t>(edge.to), edge.weight});
    if (some.size() < detail::kAtOnce && k + 1 < graph.edges().size()) continue;
    write(file, some);
    some.clear();
  }
  file.commit();
}

}  // namespace isotherm::spectral
