#include "io/incremental/irl_reader.hpp"

#include <string>
#include <vector>

#include "io/incremental/gtsam_covariance.hpp"
#include "io/information_check.hpp"
#include "io/pose_fields.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr std::size_t kPoseNumbers = 3;  // of each part of a pose: x y theta, x y z and rx ry rz

// Which of a loop's modes is measured; the others are NULL.
std::size_t measured_mode(const TextReader& text, std::size_t modes, std::size_t numbers) {
  const auto tokens = split(text.line(), " \t\r");
  std::size_t at = 5;  // LOOP, modes, the right one, two poses
  std::optional<std::size_t> measured;
  for (std::size_t mode = 0; mode < modes && at < tokens.size(); ++mode) {
    const bool null = tokens[at] == "NULL";
    at += null ? 1 : numbers;
    if (null) continue;
    if (measured) {
      text.fail("a loop of several measured modes; expected one measurement, alone or with NULL");
    }
    measured = mode;
  }
  if (!measured) text.fail("a loop without a measurement; expected one, alone or with NULL");
  return *measured;
}

void skip_null(TextReader& text) {
  if (text.word("NULL") != "NULL") text.fail("expected NULL");
}

}  // namespace

std::optional<IrlHeader> irl_header(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty() && lines.size() < 4) {
    const auto end = text.find('\n');
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  if (lines.size() < 4) return std::nullopt;
  const auto dimension = split(lines[2], " \t\r");
  const auto kind = split(lines[3], " \t\r");
  const bool poses = dimension.size() == 1 && (dimension[0] == "2" || dimension[0] == "3");
  const bool known = kind.size() == 1 && (kind[0] == "linear" || kind[0] == "nonlinear");
  if (!poses || !known) return std::nullopt;
  return IrlHeader{kind[0] == "nonlinear" ? dimension[0][0] - '0' : 0};
}

IrlEntries::IrlEntries(TextReader& text, IrlHeader header, const ReadOptions& options,
                       FileDraft& draft)
    : text_(text), header_(header), options_(options), draft_(draft) {}

void IrlEntries::read() {
  if (text_.at_line_end()) return;
  if (header_.dimension == 0) {
    text_.fail("a linear problem, of points without headings; expected a nonlinear one");
  }
  const std::string tag(text_.word("PRIOR, ODOMETRY or LOOP"));
  if (tag == "PRIOR") {
    ++draft_.report.records[tag];
    return;  // where the first pose lies is free
  }
  if (tag != "ODOMETRY" && tag != "LOOP") text_.fail("expected PRIOR, ODOMETRY or LOOP");
  ++draft_.report.records[tag];
  PoseFields fields(text_, options_, draft_.report);
  if (header_.dimension == 2) {
    edge(
        draft_.planar, [&] { return fields.planar_step(); }, tag == "LOOP");
  } else {
    edge(
        draft_.spatial, [&] { return fields.spatial_euler(); }, tag == "LOOP");
  }
}

template <class Pose, class ReadPose>
void IrlEntries::edge(GraphDraft<Pose>& draft, const ReadPose& read_pose, bool loop) {
  constexpr std::size_t kNumbers = kPoseNumbers * (Pose::kDim - 1) + Pose::kDof * Pose::kDof;
  const auto modes = text_.unsigned_integer("the number of modes");
  const auto right = text_.unsigned_integer("the mode that is right");
  const auto measured = modes == 1 ? 0 : measured_mode(text_, modes, kNumbers);
  if (!loop && modes != 1) text_.fail("expected odometry of one mode");
  const VertexId from = text_.unsigned_integer("the id of the first pose");
  const VertexId to = text_.unsigned_integer("the id of the second pose");
  for (std::size_t mode = 0; mode < measured; ++mode) skip_null(text_);
  auto& constraint = draft.constraints.emplace_back();
  draft.end_ids.emplace_back(from, to);
  draft.correct.push_back(measured == right);
  constraint.line = text_.line_number();
  constraint.link = loop ? LinkKind::loop : LinkKind::odometry;
  constraint.T_from_to = read_pose();
  constraint.information = information<typename Pose::Matrix>();
  if (!is_positive_semidefinite(constraint.information)) {
    draft.indefinite.push_back({draft.constraints.size() - 1, text_.location().column, ""});
  }
  for (std::size_t mode = measured + 1; mode < modes; ++mode) skip_null(text_);
  text_.expect_line_end();
}

template <class Matrix>
Matrix IrlEntries::information() {
  Matrix covariance;
  for (int k = 0; k < Matrix::SizeAtCompileTime; ++k) {
    covariance(k / Matrix::RowsAtCompileTime, k % Matrix::RowsAtCompileTime) =
        text_.number("a covariance entry");
  }
  return information_from_gtsam(covariance);
}

FileDraft read_irl(TextReader& text, const ReadOptions& options) {
  FileDraft draft;
  draft.report.path = text.path();
  draft.report.format = "irl";
  draft.paths = {text.path()};
  const auto header = irl_header(text.peek());
  for (int line = 0; line < IrlHeader::kLines; ++line) text.next_line();
  IrlEntries entries(text, header.value_or(IrlHeader{}), options, draft);
  while (text.next_line()) entries.read();
  draft.report.lines = text.line_number();
  if (draft.planar.empty() && draft.spatial.empty()) {
    throw ParseError({text.path(), text.line_number(), 0}, "",
                     "no odometry and no loop after the header of an IRL file");
  }
  return draft;
}

}  // namespace isotherm::slam::detail
