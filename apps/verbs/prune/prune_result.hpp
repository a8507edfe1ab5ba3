#pragma once

#include <string>

#include "command.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::apps {

/// What the result of pruning is written as (schema isotherm.prune/1).
Json to_json(const slam::PruneResult& result, const slam::PruneOptions& options);

/// Says what was found, and with --verbose how.
void tell(const slam::PruneResult& result, const CommonFlags& flags);

/// Writes the decisions about loops between vertices of `ids`, with letters of robots if there
/// are any. @throws FileError
void write_loop_verdicts(const std::string& path, const spectral::EdgeVerdicts& verdicts,
                         const std::vector<slam::VertexId>& ids);

}  // namespace isotherm::apps
