#include "isotherm/slam/optimize/optimize.hpp"

#include <string>
#include <utility>
#include <variant>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "keywords.hpp"
#include "modules.hpp"
#include "slam/pose_graph.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;
using slam::OptimizeSummary;

// A graph with the poses found, and how well they fit.
struct Optimized : OptimizeSummary {
  PoseGraphFile graph;
};

Optimized optimize_graph(const PoseGraphFile& graph, nb::kwargs given) {
  Keywords keywords("optimize", std::move(given));
  slam::OptimizeOptions options;
  keywords.take_fields(options);
  const RunKeywords run = keywords.take_run();
  keywords.finish();
  auto found = without_gil(run, nb::find(graph), [&graph, options](const RunContext& context) {
    return slam::optimize(graph.graph, options, context);
  });
  OptimizeSummary summary = found;
  return {std::move(summary), with_graph(graph, std::move(found.graph))};
}

}  // namespace

void bind_optimize(nb::module_& module) {
  nb::class_<Optimized>(module, "OptimizeResult", "The poses that fit a pose graph best.")
      .def_ro("graph", &Optimized::graph, "The graph with the poses found.")
      .def_prop_ro(
          "poses",
          [](nb::handle_t<Optimized> self) -> nb::object {
            return self.attr("graph").attr("poses");
          },
          nb::sig("def poses(self) -> numpy.typing.NDArray[numpy.float64]"),
          "n x 3 (x, y, theta) or n x 7 (x, y, z, qx, qy, qz, qw).")
      .def_prop_ro(
          "status", [](const Optimized& self) { return std::string(enum_name(self.status)); },
          "'converged', 'iteration-limit' or 'diverged'.")
      .def_prop_ro(
          "converged",
          [](const Optimized& self) { return self.status == slam::OptimizeStatus::converged; },
          "Whether the poses are an optimum.")
      .def_prop_ro(
          "chi2", [](const Optimized& self) { return view(self.chi2, nb::find(self)); },
          "Chi-squared of each edge at the poses found, without the kernel, m.")
      .def_prop_ro(
          "weight", [](const Optimized& self) { return view(self.weight, nb::find(self)); },
          "The kernel's weight of each edge, m.")
      .def_ro("iterations", &OptimizeSummary::iterations, "Steps tried.")
      .def_ro("initial_cost", &OptimizeSummary::initial_cost, "At the start.")
      .def_ro("final_cost", &OptimizeSummary::final_cost, "At the poses found.")
      .def_ro("components", &OptimizeSummary::components,
              "Connected components, each with a gauge of its own.")
      .def_ro("seconds", &OptimizeSummary::seconds, "Wall time.");

  define(module, "optimize", "graph: PoseGraph",
         keywords_of(slam::OptimizeOptions()) + run_keywords(RunTexts::threads), "OptimizeResult",
         "Find the poses that fit a pose graph best.", optimize_graph, "graph"_a);
}

}  // namespace isotherm::python
