#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "isotherm/base/read_report.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"

namespace isotherm::slam::detail {

/// What the lines of files say, before ids become positions: a file may name a
/// vertex in an edge before, or without, its own line.
template <class Pose>
struct GraphDraft {
  struct Vertex {
    VertexId id = 0;
    std::uint64_t line = 0;
    Pose pose;
    std::uint32_t file = 0;
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
  std::vector<bool> correct = {};                      // one a constraint, where a file says so
  std::vector<std::size_t> ends_of_files = {};         // of all but the last: constraints so far
  std::vector<Vertex> truth = {};                      // true poses, where a file has them

  bool empty() const noexcept { return vertices.empty() && constraints.empty(); }
};

/// A FIX entry.
struct FixedVertex {
  VertexId id = 0;
  SourceLocation where;
};

/// All that one file, or several, have.
struct FileDraft {
  GraphDraft<Pose2> planar;
  GraphDraft<Pose3> spatial;
  std::vector<FixedVertex> fixed;
  std::vector<std::string> other_lines;
  ReadReport report;
  std::vector<std::string> paths;
};

/// Reads what a file says, in one pass.
/// @throws ParseError if it is malformed or empty
FileDraft read_draft(TextReader& reader, FileFormat format, const ReadOptions& options);

/// A function that reads the present line of `reader`, which must outlive it, by itself.
std::function<FileDraft()> line_reader(TextReader& reader, FileFormat format,
                                       const ReadOptions& options);

/// Adds what `next`, a single file, has: vertices of the same id are the same.
/// @throws ParseError if one has planar poses and the other spatial ones
void append(FileDraft& draft, FileDraft next);

/// Turns ids into positions, places vertices without a line, repairs information
/// matrices, and tells robots apart by their files, all of it counted in the report.
/// @throws ParseError for repeated vertices, unknown fixed ones, or a repair
///   under `options.strict`.
PoseGraphFile finish(FileDraft draft, const ReadOptions& options);

}  // namespace isotherm::slam::detail
