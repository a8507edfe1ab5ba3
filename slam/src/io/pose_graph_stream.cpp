#include "isotherm/slam/io/pose_graph_stream.hpp"

#include <algorithm>
#include <istream>
#include <utility>

#include "io/graph_draft.hpp"
#include "isotherm/slam/io/file_format.hpp"

namespace isotherm::slam {
namespace {

// The text of one line as part of a file.
TextReader reader_of(const std::string& name, const std::string& line, std::uint64_t before) {
  return {name,
          [&line, at = std::size_t{0}](std::span<char> target) mutable {
            const std::size_t count = std::min(target.size(), line.size() - at);
            std::copy_n(line.data() + at, count, target.data());
            at += count;
            return count;
          },
          before};
}

template <class Pose>
std::optional<StreamEntry> entry_of(const detail::GraphDraft<Pose>& draft,
                                    const SourceLocation& where) {
  if (!draft.indefinite.empty()) {
    throw ParseError({where.path, where.line, draft.indefinite.front().column},
                     draft.indefinite.front().token,
                     "information matrix is not positive semi-definite");
  }
  if (!draft.constraints.empty()) {
    const auto [from, to] = draft.end_ids.front();
    return StreamEdge<Pose>{from, to, draft.constraints.front()};
  }
  if (draft.vertices.empty()) return std::nullopt;
  return StreamVertex<Pose>{draft.vertices.front().id, draft.vertices.front().pose};
}

bool is_edge_or_vertex(std::string_view tag) {
  return tag.starts_with("VERTEX_SE") || tag.starts_with("EDGE_SE2") ||
         tag.starts_with("EDGE_SE3") || tag == "VERTEX2" || tag == "VERTEX3" || tag == "EDGE2" ||
         tag == "EDGE3";
}

}  // namespace

PoseGraphStream::PoseGraphStream(std::istream& in, std::string name)
    : in_(in), name_(std::move(name)) {}

std::optional<StreamEntry> PoseGraphStream::next() {
  std::string line;
  while (std::getline(in_, line)) {
    ++line_number_;
    if (auto entry = read(line)) return entry;
  }
  return std::nullopt;
}

std::optional<StreamEntry> PoseGraphStream::read(const std::string& line) const {
  auto text = reader_of(name_, line, line_number_ - 1);
  if (!text.next_line() || text.at_line_end()) return std::nullopt;
  const std::string tag(text.word());
  if (tag == "FIX") return StreamFixed{text.unsigned_integer("a vertex id")};
  if (!is_edge_or_vertex(tag)) {
    const bool record = tag.front() == '#' || std::isalpha(static_cast<unsigned char>(tag[0])) != 0;
    if (!record) text.fail("expected a record tag such as VERTEX_SE2 or EDGE_SE3:QUAT");
    return std::nullopt;
  }
  auto again = reader_of(name_, line, line_number_ - 1);
  const auto draft = detail::read_draft(again, FileFormat::g2o, {});
  const SourceLocation where{name_, line_number_, 0};
  auto entry = entry_of(draft.planar, where);
  return entry ? entry : entry_of(draft.spatial, where);
}

}  // namespace isotherm::slam
