#include "isotherm/slam/prune/prune.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "isotherm/base/error.hpp"
#include "keywords.hpp"
#include "modules.hpp"
#include "pages.hpp"
#include "slam/pose_graph.hpp"
#include "slam/pruned.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;
using slam::PruneOptions;

std::vector<KeywordText> keywords_of_method(const PruneOptions& method) {
  return std::visit([](const auto& own) { return keywords_of(own); }, method);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// The methods that have the option.
std::vector<std::string> owners(const std::string& name) {
  std::vector<std::string> all;
  for (const auto& method : slam::prune_methods()) {
    const auto keywords = keywords_of_method(method);
    const bool has = std::any_of(keywords.begin(), keywords.end(),
                                 [&name](const KeywordText& own) { return own.name == name; });
    if (has) all.emplace_back(method_name(method));
  }
  return all;
}

void require_own(const Keywords& keywords, const PruneOptions& options) {
  for (const auto& name : keywords.left()) {
    const auto methods = owners(name);
    if (methods.empty()) continue;
    throw nb::type_error((name + ": is an option of " + joined(methods) + ", not of method " +
                          std::string(method_name(options)))
                             .c_str());
  }
  keywords.finish();
}

Pruned prune_graph(nb::handle_t<PoseGraphFile> graph, const std::string& method, nb::handle trusted,
                   nb::kwargs given) {
  Keywords keywords("prune", std::move(given));
  Pruned pruned{nb::borrow(graph), slam::prune_method(method), {}, {}};
  std::visit([&keywords](auto& own) { keywords.take_fields(own); }, pruned.options);
  const RunKeywords run = keywords.take_run();
  require_own(keywords, pruned.options);
  const auto& input = graph_of(pruned).graph;
  pruned.roles = roles_of(input, trusted);
  pruned.result = without_gil(
      run, pruned.graph,
      [&input, roles = pruned.roles, options = pruned.options](const RunContext& context) {
        return std::visit(
            [&](const auto& own) { return slam::prune(own, roles, options, context); }, input);
      });
  return pruned;
}

PoseGraphFile without_false(const Pruned& self, bool keep_ambiguous) {
  const auto& file = graph_of(self);
  return with_graph(file, apply_verdicts(file.graph, self.result.verdicts, keep_ambiguous));
}

std::string notebook_page(const Pruned& self) {
  const auto& verdicts = self.result.verdicts;
  const auto vertices =
      std::visit([](const auto& graph) { return graph.ids.size(); }, graph_of(self).graph);
  return framed(vertices, in_words(verdicts), [&self] { return page_of(self, nb::none()); });
}

nb::dict methods_of() {
  nb::dict all;
  for (const auto& method : slam::prune_methods()) {
    nb::dict options;
    for (const auto& keyword : keywords_of_method(method)) {
      options[keyword.name.c_str()] = keyword.help;
    }
    all[std::string(method_name(method)).c_str()] = options;
  }
  return all;
}

nb::dict keywords_of_datta2016() {
  const slam::HeatPruneOptions options = slam::datta2016();
  nb::dict keywords;
  keywords["method"] = python_value(std::string(options.method()));
  visit_fields(options, [&keywords](std::string_view name, const auto& value, std::string_view,
                                    const auto&...) {
    keywords[std::string(name).c_str()] = python_value(value);
  });
  return keywords;
}

// Every option of every method once. Its default is the method's own.
std::vector<KeywordText> all_keywords() {
  std::vector<KeywordText> all;
  for (const auto& method : slam::prune_methods()) {
    for (auto keyword : keywords_of_method(method)) {
      const auto same = std::find_if(all.begin(), all.end(), [&](const KeywordText& other) {
        return other.name == keyword.name;
      });
      if (same != all.end()) continue;
      keyword.help = joined(owners(keyword.name)) + ": " + keyword.help + "; " + keyword.fallback +
                     " unless given";
      keyword.type += " | None";
      keyword.fallback = "None";
      all.push_back(std::move(keyword));
    }
  }
  return all;
}

std::string method_type() {
  std::vector<std::string> names;
  for (const auto& method : slam::prune_methods()) {
    names.push_back("'" + std::string(method_name(method)) + "'");
  }
  return "typing.Literal[" + joined(names) + "]";
}

void bind_result(nb::class_<Pruned>& bound) {
  bound.def_prop_ro("verdicts", verdicts_of, "A decision for each candidate, in file order.")
      .def_prop_ro(
          "method", [](const Pruned& self) { return self.result.method; },
          "Name of the method that decided.")
      .def_prop_ro(
          "warnings", [](const Pruned& self) { return self.result.warnings; },
          "What a user should know about the result.")
      .def_prop_ro(
          "seconds", [](const Pruned& self) { return self.result.seconds; }, "Wall time.")
      .def_ro("graph", &Pruned::graph, nb::sig("def graph(self, /) -> PoseGraph"),
              "The graph that was judged.")
      .def(
          "report", [](const Pruned& self, nb::handle truth) { return page_of(self, truth); },
          "truth"_a = nb::none(),
          nb::sig("def report(self, truth: numpy.typing.ArrayLike | None = None) -> str"),
          "The page that explains the result, as HTML that needs nothing else; with the true "
          "poses, "
          "their errors, too.")
      .def("_repr_html_", notebook_page)
      .def("pruned", without_false, nb::kw_only(), "keep_ambiguous"_a = false,
           "The graph without the loops that are pruned and, unless keep_ambiguous, without those "
           "that are ambiguous. Poses are as they were: optimize() finds them.");
  bind_data_frame(
      bound, [](const Pruned& self) { return data_frame(verdicts_of(self)); }, "The verdicts");
}

}  // namespace

void bind_prune(nb::module_& module) {
  nb::class_<Pruned> bound(module, "PruneResult",
                           "What was decided about the loops of a pose graph.");
  bind_result(bound);

  module.def("prune_methods", methods_of,
             nb::sig("def prune_methods() -> dict[str, dict[str, str]]"),
             "The methods of prune(), the default first, each with its options and their meaning.");
  module.def("datta2016", keywords_of_datta2016,
             nb::sig("def datta2016() -> dict[str, typing.Any]"),
             "The keywords that make prune() the heat method as Datta et al. (2016) state it.");
  const std::string method(method_name(PruneOptions()));
  const KeywordText trusted = {
      "trusted", "numpy.typing.ArrayLike | None", "None",
      "positions of edges that are trusted in place of odometry; all others are judged"};
  define(module, "prune", "graph: PoseGraph, method: " + method_type() + " = '" + method + "'",
         std::vector<KeywordText>{trusted} + all_keywords() + run_keywords(RunTexts::seed),
         "PruneResult",
         "Decide on every loop closure of a pose graph. Each method has options of its own; one of "
         "another method is a TypeError.",
         prune_graph, "graph"_a, "method"_a = method, nb::kw_only(), "trusted"_a = nb::none());
}

}  // namespace isotherm::python
