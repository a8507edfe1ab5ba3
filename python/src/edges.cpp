#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "graph.hpp"
#include "isotherm/spectral/edges/judge_edges.hpp"
#include "keywords.hpp"
#include "modules.hpp"
#include "pages.hpp"
#include "verdicts.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;
using namespace spectral;

// What judge_edges found, with what it was asked.
struct JudgedEdges {
  nb::object graph;  // a Graph
  JudgeEdgesOptions options;
  JudgeEdgesResult result;  // vertices by position
};

const Graph& graph_of(const JudgedEdges& self) { return nb::cast<const Graph&>(self.graph); }

// Verdicts name the vertices as the input does.
Verdicts named_verdicts(const JudgedEdges& self) {
  Verdicts named{self.result.verdicts};
  const auto& ids = graph_of(self).ids;
  for (auto& row : named.rows) {
    row.from = ids[row.from];
    row.to = ids[row.to];
  }
  return named;
}

Graph kept(const JudgedEdges& self, bool keep_ambiguous) {
  const Graph& graph = graph_of(self);
  return {apply_verdicts(graph.graph, self.result.verdicts, keep_ambiguous), graph.ids,
          graph.points};
}

std::string page(const JudgedEdges& self) {
  return page_of(nb::find(self), graph_of(self), self.options, self.result);
}

JudgedEdges judge(nb::handle_t<Graph> graph, nb::kwargs given) {
  Keywords keywords("judge_edges", std::move(given));
  JudgedEdges judged{nb::borrow(graph), {}, {}};
  keywords.take_fields(judged.options);
  const nb::object trusted = keywords.take("trusted");
  if (!trusted.is_none()) judged.options.trusted = number_list<Index>(trusted, "trusted");
  const RunKeywords run = keywords.take_run();
  keywords.finish();
  const Graph& input = graph_of(judged);
  judged.result =
      without_gil(run, judged.graph, [&input, options = judged.options](const RunContext& context) {
        return judge_edges(input.graph, options, input.points, context);
      });
  return judged;
}

void bind_result(nb::class_<JudgedEdges>& bound) {
  bound.def_prop_ro("verdicts", named_verdicts, "A decision for each edge, in order.")
      .def_ro("graph", &JudgedEdges::graph, nb::sig("def graph(self, /) -> Graph"),
              "The graph that was judged.")
      .def_prop_ro(
          "method",
          [](const JudgedEdges& self) { return std::string(enum_name(self.options.method)); },
          "Name of the method that decided.")
      .def_prop_ro(
          "threshold", [](const JudgedEdges& self) { return self.result.threshold.value; },
          "What scores were compared with; infinite where there was nothing to split.")
      .def_prop_ro(
          "warnings", [](const JudgedEdges& self) { return self.result.warnings; },
          "What the scores cannot be trusted for, in words.")
      .def_prop_ro(
          "seconds", [](const JudgedEdges& self) { return self.result.seconds; }, "Wall time.")
      .def("kept", kept, nb::kw_only(), "keep_ambiguous"_a = true,
           "The graph without the edges that are pruned and, unless keep_ambiguous, without those "
           "that are ambiguous.")
      .def("report", page, nb::sig("def report(self) -> str"),
           "The page that explains the result, as HTML that needs nothing else.")
      .def("_repr_html_", [](const JudgedEdges& self) {
        return framed(graph_of(self).ids.size(), in_words(self.result.verdicts),
                      [&self] { return page(self); });
      });
  bind_data_frame(
      bound, [](const JudgedEdges& self) { return data_frame(named_verdicts(self)); },
      "The verdicts");
}

}  // namespace

void bind_edges(nb::module_& module) {
  nb::class_<JudgedEdges> bound(module, "JudgedEdges",
                                "Which edges of a graph do not belong there.");
  bind_result(bound);

  const KeywordText trusted = {"trusted", "numpy.typing.ArrayLike | None", "None",
                               "heat-multiscale: positions of edges that are known to be true"};
  define(module, "judge_edges", "graph: Graph",
         keywords_of(JudgeEdgesOptions()) + std::vector<KeywordText>{trusted} +
             run_keywords(RunTexts::seed),
         "JudgedEdges",
         "Decide on every edge of a graph by what the rest of the graph says about its ends. "
         "Method rank goes by the graph's points.",
         judge, "graph"_a);
}

}  // namespace isotherm::python
