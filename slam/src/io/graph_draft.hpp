#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "isotherm/base/read_report.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// What the lines of a file say, before ids become positions: a file may name a
/// vertex in an edge before, or without, its own line.
template <class Pose>
struct GraphDraft {
  struct Vertex {
    VertexId id = 0;
    std::uint64_t line = 0;
    Pose pose;
  };
  struct Suspect {
    std::size_t constraint = 0;
    std::uint64_t column = 0;  // where its information starts
    std::string token;         // its text; only for as many as a report keeps
  };

  std::vector<Vertex> vertices;
  std::vector<Constraint<Pose>> constraints;           // ends not set
  std::vector<std::pair<VertexId, VertexId>> end_ids;  // one a constraint
  std::vector<Suspect> indefinite;                     // not positive semi-definite

  bool empty() const noexcept { return vertices.empty() && constraints.empty(); }
};

/// A FIX entry.
struct FixedVertex {
  VertexId id = 0;
  SourceLocation where;
};

/// Turns ids into positions, places vertices without a line, and repairs
/// information matrices, all of it counted in `report`.
/// @throws ParseError for repeated vertices, unknown fixed ones, or a repair
///   under `options.strict`.
template <class Pose>
PoseGraph<Pose> finish_graph(GraphDraft<Pose> draft, const std::vector<FixedVertex>& fixed,
                             const ReadOptions& options, ReadReport& report);

}  // namespace isotherm::slam
