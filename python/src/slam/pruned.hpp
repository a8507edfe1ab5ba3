#pragma once

#include <string>

#include <nanobind/nanobind.h>

#include "isotherm/slam/prune/prune.hpp"
#include "slam/pose_graph.hpp"
#include "verdicts.hpp"

namespace isotherm::python {

/// What prune() found, with what it was asked.
struct Pruned {
  nb::object graph;  ///< a PoseGraph
  slam::PruneOptions options;
  slam::EdgeRoles roles;
  slam::PruneResult result;
};

inline const PoseGraphFile& graph_of(const Pruned& self) {
  return nb::cast<const PoseGraphFile&>(self.graph);
}

inline Verdicts verdicts_of(const Pruned& self) {
  return {self.result.verdicts, names_of(graph_of(self).graph)};
}

/// The page that explains the result. `truth` holds a pose a vertex (NaN: not known), or is None.
std::string page_of(const Pruned& pruned, nb::handle truth);

}  // namespace isotherm::python
