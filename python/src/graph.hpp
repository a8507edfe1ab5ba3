#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <Eigen/Core>

#include "arrays.hpp"
#include "isotherm/base/read_report.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::python {

/// A weighted graph as Python has it. Never changes once it is made.
struct Graph {
  spectral::WeightedGraph graph;
  std::vector<std::uint64_t> ids;  ///< what the input calls each vertex, ascending
  Eigen::MatrixXd points;          ///< dimension x vertices; empty where they are not known
  ReadReport report = {};          ///< of the file, if there was one
};

/// The vertices of a graph that nothing else names.
std::vector<std::uint64_t> counted_ids(spectral::Index count);

/// Pairs of vertices, m x 2 numbers below the graph's count.
std::vector<spectral::VertexPair> pairs_from(nb::handle value, const char* what);

/// What was noticed about a file: a dictionary of counts, and sentences.
nb::dict report_of(const ReadReport& report);

/// Gives a class `report`, on the file that it, `what` in words, was read from.
template <class Class>
void bind_read_report(nb::class_<Class>& bound, const std::string& what) {
  bound.def_prop_ro(
      "report", [](const Class& self) { return report_of(self.report); },
      nb::sig("def report(self) -> dict[str, object]"),
      ("What was noticed in the file that " + what + " was read from.").c_str());
}

}  // namespace isotherm::python
