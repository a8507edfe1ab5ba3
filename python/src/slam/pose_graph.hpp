#pragma once

#include <nanobind/nanobind.h>

#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"

namespace isotherm::python {

namespace nb = nanobind;

/// A pose graph as Python has it, with what its file has besides. Never changes once it is made.
using PoseGraphFile = slam::PoseGraphFile;

/// The same file with another graph.
PoseGraphFile with_graph(const PoseGraphFile& file, slam::AnyPoseGraph graph);

/// Which edges are trusted: those whose positions are given, or, for None, odometry.
slam::EdgeRoles roles_of(const slam::AnyPoseGraph& graph, nb::handle trusted);

/// What verdicts call the vertices, where their ids are GTSAM's keys.
spectral::VertexNames names_of(const slam::AnyPoseGraph& graph);

}  // namespace isotherm::python
