#pragma once

#include <optional>
#include <string>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/pipeline.hpp"
#include "report/report.hpp"

namespace isotherm::apps {

/// What a run of `prune` was given besides the graph.
template <class Pose>
struct PruneRun {
  std::string title;  ///< name of the input file
  slam::PipelineOptions options;
  std::vector<std::optional<Pose>> truth;  ///< one a vertex, or empty
  std::vector<slam::Robot> robots;         ///< of the graph
};

/// Explains what prune_and_optimize() made of `graph`: compares maps, chi-squared, heat
/// distances and, where it is known, the truth before and after. Time is that of
/// odometry_chi2() and of a few factorisations of the graph's Laplacian.
/// @throws NumericalError, Cancelled, InvalidArgument if the pruned graph was not optimised
template <class Pose>
Report pose_graph_report(const slam::PoseGraph<Pose>& graph,
                         const slam::PipelineResult<slam::PoseGraph<Pose>>& result,
                         const PruneRun<Pose>& run, const RunContext& context);

}  // namespace isotherm::apps
