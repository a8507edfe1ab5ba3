#include "graph.hpp"

#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"
#include "isotherm/spectral/heat/heat_scales.hpp"
#include "isotherm/spectral/resistance/effective_resistance.hpp"
#include "keywords.hpp"
#include "modules.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;
using spectral::Index;
using spectral::WeightedEdge;
using spectral::WeightedGraph;

Index vertex_count_of(const Input<Index>& ends, nb::handle given) {
  if (!given.is_none()) {
    Index count = 0;
    detail::assign("vertex_count", given, count);
    return count;
  }
  Index largest = -1;
  for (std::size_t k = 0; k < ends.size(); ++k) largest = std::max(largest, ends.data()[k]);
  return largest + 1;
}

Graph make(WeightedGraph graph, nb::handle points) {
  Graph made{std::move(graph), {}, {}};
  made.ids = counted_ids(made.graph.vertex_count());
  if (points.is_none()) return made;
  made.points = columns_of(points, "points");
  require_length("points", static_cast<std::size_t>(made.points.cols()), made.ids.size());
  return made;
}

Graph from_edges(nb::handle edges, nb::handle weights, nb::handle vertex_count, nb::handle points) {
  const auto ends = numbers<Index>(edges, "edges", {kAny, 2});
  const std::size_t count = ends.shape(0);
  std::vector<WeightedEdge> list(count);
  for (std::size_t k = 0; k < count; ++k) {
    list[k] = {ends.data()[2 * k], ends.data()[2 * k + 1], 1.0};
  }
  if (!weights.is_none()) {
    const auto given = numbers<double>(weights, "weights", {kAny});
    require_length("weights", given.size(), count);
    for (std::size_t k = 0; k < count; ++k) list[k].weight = given.data()[k];
  }
  return make(WeightedGraph(vertex_count_of(ends, vertex_count), std::move(list)), points);
}

// Row i of a symmetric matrix names each edge {i, j} once, where i < j. In ascending order of
// both, the transposed entries come one after the other.
template <class Offset>
std::vector<WeightedEdge> upper_triangle(const Input<Offset>& starts, const Input<Index>& columns,
                                         const Input<double>& values) {
  const std::size_t rows = starts.size() - 1;
  const Offset* const start = starts.data();
  std::vector<Offset> below(start, start + rows);  // next entry of each row left of the diagonal
  std::vector<WeightedEdge> edges;
  edges.reserve(values.size() / 2);
  const auto asymmetric = [] {
    return InvalidArgument("matrix", "is not symmetric, or its columns are not in order");
  };
  for (std::size_t row = 0; row < rows; ++row) {
    for (Offset k = start[row]; k < start[row + 1]; ++k) {
      const auto column = static_cast<std::size_t>(columns.data()[k]);
      if (column >= rows) throw InvalidArgument("matrix", "has a column outside of it");
      if (column <= row) continue;
      const Offset mirrored = below[column]++;
      const bool there = mirrored < start[column + 1] &&
                         columns.data()[mirrored] == static_cast<Index>(row) &&
                         values.data()[mirrored] == values.data()[k];
      if (!there) throw asymmetric();
      edges.push_back({static_cast<Index>(row), static_cast<Index>(column), values.data()[k]});
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const bool over =
        below[row] < start[row + 1] && static_cast<std::size_t>(columns.data()[below[row]]) < row;
    if (over) throw asymmetric();
  }
  return edges;
}

template <class Offset>
Graph from_rows(nb::handle indptr, nb::handle indices, nb::handle data, nb::handle points) {
  const auto starts = numbers<Offset>(indptr, "indptr", {kAny});
  const auto columns = numbers<Index>(indices, "indices", {kAny});
  const auto values = numbers<double>(data, "data", {kAny});
  require_length("data", values.size(), columns.size());
  bool sound = starts.size() > 0 && starts.data()[0] == 0 &&
               static_cast<std::size_t>(starts.data()[starts.size() - 1]) == values.size();
  for (std::size_t k = 1; sound && k < starts.size(); ++k) {
    sound = starts.data()[k - 1] <= starts.data()[k];
  }
  if (!sound) throw InvalidArgument("indptr", "must ascend from 0 to the number of entries");
  const auto rows = static_cast<Index>(starts.size() - 1);
  return make(WeightedGraph(rows, upper_triangle(starts, columns, values)), points);
}

Graph from_csr(nb::handle indptr, nb::handle indices, nb::handle data, nb::handle points) {
  const bool narrow =
      nb::hasattr(indptr, "dtype") && nb::cast<int>(indptr.attr("dtype").attr("itemsize")) <= 4;
  return narrow ? from_rows<std::int32_t>(indptr, indices, data, points)
                : from_rows<std::int64_t>(indptr, indices, data, points);
}

const WeightedEdge* first_edge(const Graph& self) {
  return self.graph.edge_count() > 0 ? self.graph.edges().data() : nullptr;
}

View2<Index> edges_of(const Graph& self) {
  static_assert(offsetof(WeightedEdge, to) == offsetof(WeightedEdge, from) + sizeof(Index));
  const WeightedEdge* const first = first_edge(self);
  return strided_rows(first != nullptr ? &first->from : nullptr, self.graph.edges().size(), 2,
                      sizeof(WeightedEdge), nb::find(self));
}

View1<double> weights_of(const Graph& self) {
  const WeightedEdge* const first = first_edge(self);
  return strided_view(first != nullptr ? &first->weight : nullptr, self.graph.edges().size(),
                      sizeof(WeightedEdge), nb::find(self));
}

nb::object edge_frame(nb::handle_t<Graph> self) {
  const nb::dict columns;
  const nb::object ids = self.attr("ids");
  const nb::object ends = ids[self.attr("edges")];
  columns["from"] = ends.attr("T")[0];
  columns["to"] = ends.attr("T")[1];
  columns["weight"] = self.attr("weights");
  return data_frame(columns);
}

Graph read(nb::handle path, bool strict, bool merge) {
  auto file = spectral::read_graph(path_of(path), {.strict = strict});
  if (merge) spectral::merge_directions(file, {.strict = strict});
  return {std::move(file.graph), std::move(file.ids), {}, std::move(file.report)};
}

// Compressed columns, which of a symmetric matrix are its rows.
nb::tuple laplacian(const Graph& graph, const std::string& kind) {
  using spectral::LaplacianKind;
  auto* const kept = new spectral::Laplacian(graph.graph, enum_value<LaplacianKind>("kind", kind));
  nb::capsule owner(
      kept, [](void* memory) noexcept { delete static_cast<spectral::Laplacian*>(memory); });
  const auto& matrix = kept->matrix();
  const auto entries = static_cast<std::size_t>(matrix.nonZeros());
  return nb::make_tuple(
      strided_view(matrix.valuePtr(), entries, sizeof(double), owner),
      strided_view(matrix.innerIndexPtr(), entries, sizeof(Index), owner),
      strided_view(matrix.outerIndexPtr(), static_cast<std::size_t>(matrix.cols()) + 1,
                   sizeof(Index), owner));
}

void bind_making(nb::class_<Graph>& bound) {
  bound
      .def(
          "__init__",
          [](Graph* self, nb::handle edges, nb::handle weights, nb::handle vertex_count,
             nb::handle points) {
            new (self) Graph(from_edges(edges, weights, vertex_count, points));
          },
          "edges"_a, "weights"_a = nb::none(), nb::kw_only(), "vertex_count"_a = nb::none(),
          "points"_a = nb::none(),
          nb::sig("def __init__(self, edges: numpy.typing.ArrayLike, weights: "
                  "numpy.typing.ArrayLike | None = None, *, vertex_count: int | None = None, "
                  "points: numpy.typing.ArrayLike | None = None) -> None"),
          "Edges m x 2 of vertices from 0, their weights m (1 where there are none), how many "
          "vertices there are (else as many as the edges name), and where they are, n x d.")
      .def_static("from_csr", from_csr, "indptr"_a, "indices"_a, "data"_a, nb::kw_only(),
                  "points"_a = nb::none(),
                  nb::sig("def from_csr(indptr: numpy.typing.ArrayLike, indices: "
                          "numpy.typing.ArrayLike, data: numpy.typing.ArrayLike, *, points: "
                          "numpy.typing.ArrayLike | None = None) -> Graph"),
                  "The graph of a symmetric matrix of weights in compressed rows, with columns in "
                  "order. int32 and float64 are read where they are. The diagonal is left out.");
}

void bind_contents(nb::class_<Graph>& bound) {
  bound.def("__len__", [](const Graph& self) { return self.graph.vertex_count(); })
      .def("__repr__",
           [](const Graph& self) {
             return "Graph(" + std::to_string(self.graph.vertex_count()) + " vertices, " +
                    std::to_string(self.graph.edge_count()) + " edges)";
           })
      .def_prop_ro(
          "vertex_count", [](const Graph& self) { return self.graph.vertex_count(); },
          "How many vertices there are.")
      .def_prop_ro(
          "edge_count", [](const Graph& self) { return self.graph.edge_count(); },
          "How many edges there are.")
      .def_prop_ro("edges", edges_of, "The vertices that each edge joins, m x 2.")
      .def_prop_ro("weights", weights_of, "The weight of each edge, m.")
      .def_prop_ro(
          "ids", [](const Graph& self) { return view(self.ids, nb::find(self)); },
          "The number that the input gives to each vertex, n.")
      .def_prop_ro(
          "points",
          [](const Graph& self) -> std::optional<View2<double>> {
            if (self.points.size() == 0) return std::nullopt;
            return rows_of(self.points, nb::find(self));
          },
          nb::sig("def points(self) -> numpy.typing.NDArray[numpy.float64] | None"),
          "Where the vertices are, n x d, if that is known.");
  bind_read_report(bound, "the graph");
  bind_data_frame(bound, edge_frame, "from, to and weight of each edge");
}

void bind_class(nb::module_& module) {
  nb::class_<Graph> bound(
      module, "Graph",
      "A weighted graph: undirected edges, each with an affinity above 0. Vertices "
      "are numbered from 0; `ids` are the numbers that a file gave them. A graph "
      "never changes, and its arrays are views that cannot be written.");
  bind_making(bound);
  bind_contents(bound);
}

void bind_files(nb::module_& module) {
  module.def("read_graph", read, "path"_a, nb::kw_only(), "strict"_a = false,
             "merge_directions"_a = true,
             nb::sig("def read_graph(path: str | os.PathLike[str], *, strict: bool = False, "
                     "merge_directions: bool = True) -> Graph"),
             "Read rows of from, to and weight, or a symmetric MatrixMarket file. Both directions "
             "of an edge become one, unless merge_directions is False.");
  module.def(
      "write_edge_csv",
      [](nb::handle path, const Graph& graph) {
        spectral::write_edge_csv(path_of(path), graph.graph, graph.ids);
      },
      "path"_a, "graph"_a,
      nb::sig("def write_edge_csv(path: str | os.PathLike[str], graph: Graph) -> None"),
      "Write rows of from, to and weight.");
  module.def(
      "write_matrix_market",
      [](nb::handle path, const Graph& graph) {
        spectral::write_matrix_market(path_of(path), graph.graph);
      },
      "path"_a, "graph"_a,
      nb::sig("def write_matrix_market(path: str | os.PathLike[str], graph: Graph) -> None"),
      "Write the matrix of weights in MatrixMarket's format.");
}

}  // namespace

std::vector<std::uint64_t> counted_ids(Index count) {
  std::vector<std::uint64_t> ids(static_cast<std::size_t>(count));
  std::iota(ids.begin(), ids.end(), std::uint64_t{0});
  return ids;
}

std::vector<spectral::VertexPair> pairs_from(nb::handle value, const char* what) {
  const auto ends = numbers<Index>(value, what, {kAny, 2});
  std::vector<spectral::VertexPair> pairs(ends.shape(0));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairs[k] = {ends.data()[2 * k], ends.data()[2 * k + 1]};
  }
  return pairs;
}

nb::dict report_of(const ReadReport& report) {
  const auto counts = [](const std::map<std::string, std::uint64_t>& by_name) {
    nb::dict all;
    for (const auto& [name, count] : by_name) all[name.c_str()] = count;
    return all;
  };
  std::vector<std::string> diagnostics;
  for (const auto& found : report.diagnostics) diagnostics.push_back(to_string(found));
  nb::dict all;
  all["path"] = report.path;
  all["format"] = report.format;
  all["lines"] = report.lines;
  all["records"] = counts(report.records);
  all["skipped"] = counts(report.skipped);
  all["repairs"] = counts(report.repairs);
  all["notes"] = counts(report.notes);
  all["diagnostics"] = diagnostics;
  return all;
}

void bind_graphs(nb::module_& module) {
  bind_class(module);
  bind_files(module);
  module.def(
      "connected_components",
      [](const Graph& graph) { return give(spectral::connected_components(graph.graph).label); },
      "graph"_a, "The component of each vertex, from 0 in the order of their first vertices.");
  module.def("laplacian", laplacian, "graph"_a, "kind"_a = "combinatorial",
             nb::sig("def laplacian(graph: Graph, kind: typing.Literal['combinatorial', "
                     "'normalised'] = 'combinatorial') -> "
                     "tuple[numpy.typing.NDArray[numpy.float64], "
                     "numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]"),
             "The graph's Laplacian as (data, indices, indptr) of compressed rows, from which "
             "scipy.sparse.csr_array makes a matrix without a copy.");
  define(
      module, "automatic_scales", "graph: Graph", run_keywords(RunTexts::threads),
      "numpy.typing.NDArray[numpy.float64]",
      "Seven diffusion times of a graph, from where only components are left to 0.001.",
      [](const Graph& graph, nb::kwargs given) {
        Keywords keywords("automatic_scales", std::move(given));
        const RunKeywords run = keywords.take_run();
        keywords.finish();
        return give(without_gil(run, nb::find(graph), [&graph](const RunContext& context) {
          return spectral::automatic_scales(graph.graph, context);
        }));
      },
      "graph"_a);
}

}  // namespace isotherm::python
