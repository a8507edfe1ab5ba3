#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/edges/judge_edges.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "report/report.hpp"

namespace isotherm::apps {

/// What a run of `edges` was given besides the graph.
struct EdgesRun {
  std::string title;  ///< name of the input file
  spectral::JudgeEdgesOptions options;
  std::vector<std::uint64_t> ids;  ///< the file's number of each vertex
  Eigen::MatrixXd points;          ///< dimension x vertices, or empty
};

/// Explains which edges of a plain graph were judged false. Points in the plane or in
/// space are drawn where they are; other graphs at their commute-time coordinates, before
/// with all edges and after with those that are left.
/// @throws NumericalError, Cancelled
Report graph_report(const spectral::WeightedGraph& graph, const spectral::WeightedGraph& left,
                    const spectral::JudgeEdgesResult& result, const EdgesRun& run,
                    const RunContext& context);

}  // namespace isotherm::apps
