#include "distributed/read/pose_rows.hpp"

#include <array>

namespace isotherm::spectral::distributed::detail {

struct PoseRows::Record {
  std::string_view tag;
  int ends = 0;     // vertices that are named
  int numbers = 0;  // that follow
};

namespace {

constexpr int kPlane = 3, kSpace = 7, kEuler = 6;             // numbers of a pose
constexpr int kPlaneInformation = 6, kSpaceInformation = 21;  // of an upper triangle

}  // namespace

bool is_pose_record(std::string_view line) {
  return line.starts_with("VERTEX") || line.starts_with("EDGE") || line.starts_with("FIX");
}

bool PoseRows::next(spectral::detail::FileEdge& edge) {
  static constexpr std::array<Record, 11> kRecords = {{
      {"EDGE_SE3:QUAT", 2, kSpace + kSpaceInformation},
      {"EDGE_SE2", 2, kPlane + kPlaneInformation},
      {"VERTEX_SE3:QUAT", 1, kSpace},
      {"VERTEX_SE2", 1, kPlane},
      {"EDGE2", 2, kPlane + kPlaneInformation},
      {"EDGE3", 2, kEuler + kSpaceInformation},
      {"VERTEX2", 1, kPlane},
      {"VERTEX3", 1, kEuler},
      {"EDGE_SE2_SWITCHABLE", 2, 1 + kPlane + kPlaneInformation},
      {"EDGE_SE3_SWITCHABLE", 2, 1 + kSpace + kSpaceInformation},
      {"EDGE_SE2_MAXMIX", 2, 1 + kPlane + kPlaneInformation},
  }};
  while (text_.next_line()) {
    if (text_.at_line_end()) continue;
    const auto tag = text_.word();
    for (const auto& record : kRecords) {
      if (tag == record.tag && take(record, edge)) return true;
    }
  }
  return false;
}

/// Whether the record is an edge.
bool PoseRows::take(const Record& record, spectral::detail::FileEdge& edge) {
  edge = {text_.unsigned_integer("a vertex id"), 0, 1.0};
  if (record.ends == 2) edge.to = text_.unsigned_integer("a vertex id");
  for (int k = 0; k < record.numbers; ++k) text_.number("a number");
  // rtabmap ends its edges with the type of the link.
  if (record.ends == 2 && !text_.at_line_end()) text_.unsigned_integer("a link type");
  text_.expect_line_end();
  if (record.ends == 1) vertices_.push_back(edge.from);
  return record.ends == 2;
}

}  // namespace isotherm::spectral::distributed::detail
