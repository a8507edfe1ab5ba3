#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "graph.hpp"
#include "isotherm/spectral/eigen/embed.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"
#include "isotherm/spectral/resistance/effective_resistance.hpp"
#include "keywords.hpp"
#include "modules.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;
using namespace spectral;

// Coordinates with the numbers of the vertices.
struct Coordinates : EmbedResult {
  std::vector<std::uint64_t> ids;
};

Coordinates embed_graph(const Graph& graph, nb::kwargs given) {
  Keywords keywords("embed", std::move(given));
  EmbedOptions options;
  keywords.take_fields(options);
  const RunKeywords run = keywords.take_run();
  keywords.finish();
  return {without_gil(run, nb::find(graph),
                      [&graph, options](const RunContext& context) {
                        return embed(graph.graph, options, context.progress);
                      }),
          graph.ids};
}

nb::object coordinate_frame(nb::handle_t<Coordinates> self) {
  const auto& result = nb::cast<const Coordinates&>(self);
  const nb::dict columns;
  columns["vertex"] = view(result.ids, self);
  for (Eigen::Index c = 0; c < result.rows.cols(); ++c) {
    const std::string name = "x" + std::to_string(c);
    columns[name.c_str()] =
        strided_view(result.rows.col(c).data(), static_cast<std::size_t>(result.rows.rows()),
                     sizeof(double), self);
  }
  return data_frame(columns);
}

EigenDecomposition eigenpairs(const Graph& graph, const std::string& kind, nb::kwargs given) {
  Keywords keywords("eigenpairs", std::move(given));
  EigenOptions options;
  keywords.take_fields(options);
  const RunKeywords run = keywords.take_run();
  keywords.finish();
  const auto of = enum_value<LaplacianKind>("kind", kind);
  return without_gil(run, nb::find(graph),
                     [&graph, of, options](const RunContext& context) mutable {
                       options.progress = context.progress;
                       return smallest_eigenpairs(Laplacian(graph.graph, of), options);
                     });
}

HeatDistanceResult heat(const Graph& graph, nb::handle pairs, nb::handle scales, nb::kwargs given) {
  Keywords keywords("heat_distances", std::move(given));
  HeatDistanceOptions options;
  keywords.take_fields(options);
  const RunKeywords run = keywords.take_run();
  keywords.finish();
  return without_gil(
      run, nb::find(graph),
      [&graph, options, of = pairs_from(pairs, "pairs"),
       times = number_list<double>(scales, "scales")](const RunContext& context) mutable {
        options.threads = context.threads;
        options.progress = context.progress;
        return heat_distances(graph.graph, of, times, options);
      });
}

View2<double> heat_view(const HeatDistanceResult& self, double CertifiedValue::*member) {
  const std::size_t columns = self.scales.size();
  static const CertifiedValue kNone = {};
  const CertifiedValue& first = self.values.empty() ? kNone : self.values.front();
  constexpr auto kStep = static_cast<std::int64_t>(sizeof(CertifiedValue) / sizeof(double));
  return View2<double>(&(first.*member), {self.pairs.size(), columns}, nb::find(self),
                       {kStep * static_cast<std::int64_t>(columns), kStep});
}

ResistanceResult resistances(const Graph& graph, nb::handle pairs, nb::kwargs given) {
  Keywords keywords("effective_resistances", std::move(given));
  const RunKeywords run = keywords.take_run();
  keywords.finish();
  if (pairs.is_none()) {
    return without_gil(run, nb::find(graph),
                       [&graph](const RunContext&) { return edge_resistances(graph.graph); });
  }
  return without_gil(run, nb::find(graph),
                     [&graph, of = pairs_from(pairs, "pairs")](const RunContext&) {
                       return effective_resistances(graph.graph, of);
                     });
}

void bind_eigenpairs(nb::module_& module) {
  nb::class_<EigenDecomposition>(module, "Eigenpairs",
                                 "The smallest eigenpairs of a Laplacian, ascending.")
      .def_prop_ro(
          "values",
          [](const EigenDecomposition& self) { return view(self.values, nb::find(self)); },
          "Eigenvalues, k.")
      .def_prop_ro(
          "vectors",
          [](const EigenDecomposition& self) { return view(self.vectors, nb::find(self)); },
          "Orthonormal eigenvectors, n x k.")
      .def_prop_ro(
          "bounds",
          [](const EigenDecomposition& self) { return view(self.bounds, nb::find(self)); },
          "How far each value may be from an eigenvalue, k.")
      .def_prop_ro(
          "residuals",
          [](const EigenDecomposition& self) { return view(self.residuals, nb::find(self)); },
          "|L u - lambda u| of each pair, k.")
      .def_ro("null_count", &EigenDecomposition::null_count, "Leading pairs of eigenvalue 0.")
      .def_ro("seconds", &EigenDecomposition::seconds, "Wall time.")
      .def_prop_ro(
          "converged",
          [](const EigenDecomposition& self) { return self.status == EigenStatus::converged; },
          "Whether all pairs are there, as exact as asked for.");
}

void bind_embedding(nb::module_& module) {
  nb::class_<Coordinates> bound(module, "Embedding", "Coordinates for the vertices of a graph.");
  bound
      .def_prop_ro(
          "coordinates", [](const Coordinates& self) { return view(self.rows, nb::find(self)); },
          "One row a vertex, n x k; fewer columns than asked for where there are no more.")
      .def_prop_ro(
          "eigen", [](const Coordinates& self) -> const EigenDecomposition& { return self.eigen; },
          nb::rv_policy::reference_internal, "The eigenpairs that they were made from.")
      .def_ro("components", &EmbedResult::components, "Connected components of the graph.")
      .def_prop_ro(
          "ids", [](const Coordinates& self) { return view(self.ids, nb::find(self)); },
          "The number that the input gives to each vertex, n.");
  bind_data_frame(bound, coordinate_frame, "vertex, x0, x1 and so on");
}

void bind_heat_distances(nb::module_& module) {
  nb::class_<HeatDistanceResult>(
      module, "HeatDistances",
      "Squared heat distances of pairs (rows) at scales (columns), each known to lie between its "
      "bounds.")
      .def_prop_ro(
          "values",
          [](const HeatDistanceResult& self) { return heat_view(self, &CertifiedValue::value); },
          "Middles of the brackets, pairs x scales.")
      .def_prop_ro(
          "lower",
          [](const HeatDistanceResult& self) { return heat_view(self, &CertifiedValue::lower); },
          "Lower bounds.")
      .def_prop_ro(
          "upper",
          [](const HeatDistanceResult& self) { return heat_view(self, &CertifiedValue::upper); },
          "Upper bounds.")
      .def_prop_ro(
          "scales",
          [](const HeatDistanceResult& self) { return view(self.scales, nb::find(self)); },
          "Diffusion times.")
      .def_prop_ro("converged", &HeatDistanceResult::converged,
                   "Whether all brackets are as narrow as asked for.")
      .def_ro("imprecise", &HeatDistanceResult::imprecise,
              "How many values are not known to a millionth of themselves.")
      .def_ro("seconds", &HeatDistanceResult::seconds, "Wall time.");
}

void bind_resistances(nb::module_& module) {
  nb::class_<ResistanceResult>(module, "Resistances", "Effective resistances of pairs.")
      .def_prop_ro(
          "values", [](const ResistanceResult& self) { return view(self.values, nb::find(self)); },
          "One a pair; infinite between components.")
      .def_prop_ro(
          "without",
          [](const ResistanceResult& self) { return view(self.without, nb::find(self)); },
          "The same without the edges that join a pair directly.")
      .def_ro("bound", &ResistanceResult::bound,
              "Bound on the relative error of each; infinite where none is known.")
      .def_ro("seconds", &ResistanceResult::seconds, "Wall time.");
}

}  // namespace

void bind_spectra(nb::module_& module) {
  bind_eigenpairs(module);
  bind_embedding(module);
  bind_heat_distances(module);
  bind_resistances(module);
  const auto run = run_keywords(RunTexts::threads);
  define(module, "embed", "graph: Graph", keywords_of(EmbedOptions()) + run, "Embedding",
         "Give the vertices of a graph coordinates, from the smallest eigenpairs of its "
         "Laplacian.",
         embed_graph, "graph"_a);
  define(module, "eigenpairs",
         "graph: Graph, kind: typing.Literal['combinatorial', 'normalised'] = 'combinatorial'",
         keywords_of(EigenOptions()) + run, "Eigenpairs",
         "The smallest eigenpairs of a graph's Laplacian.", eigenpairs, "graph"_a,
         "kind"_a = "combinatorial");
  define(module, "heat_distances",
         "graph: Graph, pairs: numpy.typing.ArrayLike, scales: numpy.typing.ArrayLike",
         keywords_of(HeatDistanceOptions()) + run, "HeatDistances",
         "Squared heat distances of pairs of vertices (m x 2) at several diffusion times, with "
         "certified bounds.",
         heat, "graph"_a, "pairs"_a, "scales"_a);
  define(module, "effective_resistances",
         "graph: Graph, pairs: numpy.typing.ArrayLike | None = None", run, "Resistances",
         "Effective resistances of pairs of vertices (m x 2), or of all edges.", resistances,
         "graph"_a, "pairs"_a = nb::none());
}

}  // namespace isotherm::python
