#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "graph/edge_rows.hpp"
#include "isotherm/base/text_reader.hpp"

namespace isotherm::spectral::distributed::detail {

/// Whether a line is a record of a pose graph in g2o or TORO format.
bool is_pose_record(std::string_view line);

/// The structure of a pose graph: its edges, of weight 1, and its vertices. What else a record
/// says is only checked to be numbers, as many as belong there.
class PoseRows {
 public:
  explicit PoseRows(TextReader text) : text_(std::move(text)) {}

  /// False at the end. @throws ParseError
  bool next(spectral::detail::FileEdge& edge);

  /// Vertices with a line of their own, up to now.
  std::vector<std::uint64_t>& vertices() { return vertices_; }

 private:
  struct Record;
  bool take(const Record& record, spectral::detail::FileEdge& edge);

  TextReader text_;
  std::vector<std::uint64_t> vertices_;
};

}  // namespace isotherm::spectral::distributed::detail
