#pragma once

#include <optional>
#include <string>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/prune/prune.hpp"
#include "report/report.hpp"

namespace isotherm::apps {

/// What a run of `prune` was given besides the graph.
template <class Pose>
struct PruneRun {
  std::string title;  ///< name of the input file
  slam::PruneOptions options;
  bool keep_ambiguous = false;
  std::vector<std::optional<Pose>> truth;  ///< one a vertex, or empty
};

/// Explains a pruning: optimises what is left, and compares maps, chi-squared, heat
/// distances and, where it is known, the truth before and after. Time is that of
/// optimize(), of odometry_chi2() and of a few factorisations of the graph's Laplacian.
/// @throws NumericalError, Cancelled
template <class Pose>
Report pose_graph_report(const slam::PoseGraph<Pose>& graph, const slam::EdgeRoles& roles,
                         const slam::PruneResult& decisions, const PruneRun<Pose>& run);

}  // namespace isotherm::apps
