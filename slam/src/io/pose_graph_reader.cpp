#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>

#include "io/graph_draft.hpp"
#include "io/incremental/irl_reader.hpp"
#include "io/incremental/jrl_reader.hpp"
#include "io/information_check.hpp"
#include "io/pose_fields.hpp"
#include "io/unused_records.hpp"
#include "isotherm/slam/io/file_format.hpp"
#include "matrices/decompositions.hpp"

namespace isotherm::slam::detail {
namespace {

enum class Tag {
  vertex_se2,
  vertex_se3,
  edge_se2,
  edge_se3,
  fix,
  vertex2,
  vertex3,
  edge2,
  edge3,
  switchable_se2,
  switchable_se3,
  mixture_se2,
};

constexpr std::array<std::pair<std::string_view, Tag>, 12> kTags = {{
    {"EDGE_SE3:QUAT", Tag::edge_se3},
    {"EDGE_SE2", Tag::edge_se2},
    {"VERTEX_SE3:QUAT", Tag::vertex_se3},
    {"VERTEX_SE2", Tag::vertex_se2},
    {"FIX", Tag::fix},
    {"EDGE2", Tag::edge2},
    {"EDGE3", Tag::edge3},
    {"VERTEX2", Tag::vertex2},
    {"VERTEX3", Tag::vertex3},
    {"EDGE_SE2_SWITCHABLE", Tag::switchable_se2},
    {"EDGE_SE3_SWITCHABLE", Tag::switchable_se3},
    {"EDGE_SE2_MAXMIX", Tag::mixture_se2},
}};

// The last links that rtabmap numbers: 0 and 6 are odometry, between them are loops.
constexpr std::uint64_t kLastLinkType = 6;

// Entries (row, column) of an information matrix in the order of a line.
template <int kDof>
using EntryOrder = std::array<std::pair<int, int>, kDof*(kDof + 1) / 2>;

template <int kDof>
constexpr EntryOrder<kDof> upper_triangle_by_rows() {
  EntryOrder<kDof> order{};
  std::size_t next = 0;
  for (int row = 0; row < kDof; ++row) {
    for (int column = row; column < kDof; ++column) order[next++] = {row, column};
  }
  return order;
}

constexpr auto kG2oOrder2 = upper_triangle_by_rows<3>();
constexpr auto kG2oOrder3 = upper_triangle_by_rows<6>();
// G. Grisetti's TORO: I11 I12 I22 I33 I13 I23.
constexpr EntryOrder<3> kToroOrder2 = {{{0, 0}, {0, 1}, {1, 1}, {2, 2}, {0, 2}, {1, 2}}};

template <class Matrix, std::size_t kCount>
Matrix arranged(const std::array<double, kCount>& entries,
                const std::array<std::pair<int, int>, kCount>& order) {
  Matrix m;
  for (std::size_t k = 0; k < kCount; ++k) {
    m(order[k].first, order[k].second) = entries[k];
    m(order[k].second, order[k].first) = entries[k];
  }
  return m;
}

constexpr std::size_t kMostKeptBytes = std::size_t{64} << 20;
constexpr std::size_t kLongestTag = 64;
constexpr std::size_t kMostTags = 1000;

class PoseGraphReader {
 public:
  PoseGraphReader(TextReader& text, FileFormat format, const ReadOptions& options)
      : text_(text),
        options_(options),
        fields_(text, options, file_.report),
        untagged_(format == FileFormat::edge_rows),
        named_(format == FileFormat::pyfg) {
    file_.report.path = text.path();
    file_.paths = {text.path()};
  }

  FileDraft run() {
    while (text_.next_line()) read_line();
    finish();
    return std::move(file_);
  }

  /// What the present line says, by itself.
  FileDraft one_line() {
    file_ = {};
    read_line();
    return file_;
  }

 private:
  void read_line() {
    if (text_.at_line_end()) return;
    if (untagged_ && !text_.line().starts_with('#')) return read_known(Tag::edge_se2);
    const auto tag = text_.word();
    if (tag.front() == '#') {
      return keep_line();
    }
    for (const auto& [name, value] : kTags) {
      if (tag != name) continue;
      return read_known(value);
    }
    keep_unknown(tag);
  }

  void read_known(Tag tag) {
    ++counts_[static_cast<std::size_t>(tag)];
    read_record(tag);
    if (tag == Tag::edge_se2 || tag == Tag::switchable_se2) read_link_type(file_.planar);
    if (tag == Tag::edge_se3 || tag == Tag::switchable_se3) read_link_type(file_.spatial);
    text_.expect_line_end();
  }

  // rtabmap ends its edges with the type of the link.
  template <class Pose>
  void read_link_type(GraphDraft<Pose>& draft) {
    if (untagged_ || named_ || text_.at_line_end()) return;
    std::uint64_t type = 0;
    const auto token = text_.word();
    if (!parse_unsigned(token, type) || type > kLastLinkType) {
      text_.fail("expected the end of the line, or a link type from 0 to " +
                 std::to_string(kLastLinkType));
    }
    const bool odometry = type == 0 || type == kLastLinkType;
    draft.constraints.back().link = odometry ? LinkKind::odometry : LinkKind::loop;
  }

  // An edge that other programs may switch off, or hold against a wider one, is a loop.
  // What they start its switch or weight at is no measurement.
  template <class Pose, class ReadPose>
  void switchable(GraphDraft<Pose>& draft, const ReadPose& read_pose) {
    file_.report.add_note({"switchable edge", text_.location(), "",
                           "switchable edge; read as a loop without its switch"});
    edge(
        draft,
        [&] {
          text_.number("a switch or a weight");
          return read_pose();
        },
        upper_triangle_by_rows<Pose::kDof>());
    draft.constraints.back().link = LinkKind::loop;
  }

  void read_record(Tag tag) {
    switch (tag) {
      case Tag::vertex_se2:
      case Tag::vertex2:
        return vertex(file_.planar, [this] { return fields_.planar(); });
      case Tag::vertex_se3:
        return vertex(file_.spatial, [this] { return fields_.spatial(); });
      case Tag::vertex3:
        return vertex(file_.spatial, [this] { return fields_.spatial_euler(); });
      case Tag::edge_se2:
        return edge(
            file_.planar, [this] { return fields_.planar_step(); }, kG2oOrder2);
      case Tag::edge2:
        return edge(
            file_.planar, [this] { return fields_.planar_step(); }, kToroOrder2);
      case Tag::edge_se3:
        return edge(
            file_.spatial, [this] { return fields_.spatial(); }, kG2oOrder3);
      case Tag::edge3:
        return edge(
            file_.spatial, [this] { return fields_.spatial_euler(); }, kG2oOrder3);
      case Tag::switchable_se2:
      case Tag::mixture_se2:
        return switchable(file_.planar, [this] { return fields_.planar_step(); });
      case Tag::switchable_se3:
        return switchable(file_.spatial, [this] { return fields_.spatial(); });
      case Tag::fix:
        do {
          const VertexId id = vertex_id("a vertex id");
          file_.fixed.push_back({id, text_.location()});
        } while (!text_.at_line_end());
    }
  }

  // Records of other kinds are kept for writing; what starts with no letter is
  // not a record but damage.
  void keep_unknown(std::string_view tag) {
    if (std::isalpha(static_cast<unsigned char>(tag.front())) == 0) {
      text_.fail("expected a record tag such as VERTEX_SE2 or EDGE_SE3:QUAT");
    }
    if (tag == "VERTEX_SWITCH" || tag == "EDGE_SWITCH_PRIOR") {
      ++file_.report.skipped[std::string(tag)];
      return;  // said with the edges that they belong to
    }
    auto& skipped = file_.report.skipped;
    std::string name(tag.substr(0, kLongestTag));
    if (skipped.size() >= kMostTags && skipped.count(name) == 0) name = "(other)";
    if (skipped[name]++ == 0) {
      const auto known = unused_record(tag);
      file_.report.add_note({known.empty() ? "unknown record" : "unused " + name, text_.location(),
                             std::string(tag),
                             (known.empty() ? "unknown record" : std::string(known)) +
                                 "; kept as it stands but not used"});
    }
    if (!named_) keep_line();
  }

  // Comments and records of other kinds, for writing, as long as there is room: a small
  // compressed file may hold any amount of them.
  void keep_line() {
    kept_bytes_ += sizeof(std::string) + text_.line().size();
    if (kept_bytes_ <= kMostKeptBytes) {
      file_.other_lines.emplace_back(text_.line());
    } else if (!std::exchange(left_out_, true)) {
      file_.report.add_note({"left out", text_.location(), "",
                             "from here on, comments and unknown records are not kept: there "
                             "are more than 64 MB of them"});
    }
  }

  // PyFG names a vertex by a letter and a number: GTSAM's 64-bit key.
  VertexId vertex_id(std::string_view what) {
    if (!named_) return text_.unsigned_integer(what);
    const auto name = text_.word(what);
    std::uint64_t number = 0;
    if (std::isalpha(static_cast<unsigned char>(name.front())) == 0 ||
        !parse_unsigned(name.substr(1), number) || number >> 56 != 0) {
      text_.fail("expected " + std::string(what) + ", a letter and a number below 2^56");
    }
    return static_cast<VertexId>(name.front()) << 56 | number;
  }

  // Squares of larger numbers leave the range of a double.
  double information_entry() {
    constexpr double kLargest = 1e100;
    const double value = text_.number("an information entry");
    if (std::abs(value) > kLargest) text_.fail("expected an information entry of at most 1e100");
    return value;
  }

  // What is no covariance gets an information matrix that is found out as
  // indefinite.
  template <class Matrix>
  static Matrix inverse_covariance(const Matrix& covariance) {
    const Matrix inverse = covariance.inverse();
    if (!inverse.allFinite()) return -Matrix::Identity();
    return 0.5 * (inverse + inverse.transpose());
  }

  template <class Pose>
  void check_dimension() const {
    const bool mixed = Pose::kDim == 2 ? !file_.spatial.empty() : !file_.planar.empty();
    if (mixed) {
      text_.fail(Pose::kDim == 2 ? "planar record in a file of spatial poses"
                                 : "spatial record in a file of planar poses");
    }
  }

  template <class Pose, class ReadPose>
  void vertex(GraphDraft<Pose>& draft, const ReadPose& read_pose) {
    check_dimension<Pose>();
    if (named_) text_.number("a time stamp");
    const VertexId id = vertex_id("a vertex id");
    draft.vertices.push_back({id, text_.line_number(), read_pose()});
  }

  template <class Pose, class ReadPose, std::size_t kCount>
  void edge(GraphDraft<Pose>& draft, const ReadPose& read_pose,
            const std::array<std::pair<int, int>, kCount>& order) {
    check_dimension<Pose>();
    if (named_) text_.number("a time stamp");
    const VertexId from = vertex_id("the id of the first vertex");
    const VertexId to = vertex_id("the id of the second vertex");
    if (from == to) {
      file_.report.add_note(
          {"self edge", text_.location(), std::to_string(to), "edge from a vertex to itself"});
    }
    auto& constraint = draft.constraints.emplace_back();
    draft.end_ids.emplace_back(from, to);
    constraint.line = text_.line_number();
    constraint.T_from_to = read_pose();

    std::array<double, kCount> entries;
    entries[0] = information_entry();
    const std::uint64_t column = text_.location().column;
    for (std::size_t k = 1; k < kCount; ++k) entries[k] = information_entry();
    constraint.information = arranged<typename Pose::Matrix>(entries, order);
    if (named_) constraint.information = inverse_covariance(constraint.information);
    if (is_positive_semidefinite(constraint.information)) return;
    if (!reordered(constraint, entries, order, column)) {
      const bool kept = draft.indefinite.size() < ReadReport::kKeptPerKind;
      draft.indefinite.push_back(
          {draft.constraints.size() - 1, column, kept ? std::string(text_.text_from(column)) : ""});
    }
  }

  // Some programs write EDGE2 in the order of g2o: use that where TORO's own is
  // impossible and the other is not.
  template <class Pose, std::size_t kCount>
  bool reordered(Constraint<Pose>& constraint, const std::array<double, kCount>& entries,
                 const std::array<std::pair<int, int>, kCount>& order, std::uint64_t column) {
    if constexpr (Pose::kDof == 3) {
      if (order == kG2oOrder2) return false;
      const auto by_rows = arranged<typename Pose::Matrix>(entries, kG2oOrder2);
      if (!is_positive_semidefinite(by_rows)) return false;
      file_.report.add_repair(options_, {"information reordered",
                                         {text_.path(), text_.line_number(), column},
                                         std::string(text_.text_from(column)),
                                         "information is not positive semi-definite in TORO's "
                                         "order of entries; read by rows"});
      constraint.information = by_rows;
      return true;
    } else {
      return false;
    }
  }

  void finish() {
    auto& report = file_.report;
    report.lines = text_.line_number();
    for (const auto& [name, tag] : kTags) {
      const auto count = counts_[static_cast<std::size_t>(tag)];
      if (count > 0) report.records[std::string(name)] = count;
    }
    fields_.finish();
    if (file_.planar.empty() && file_.spatial.empty()) {
      const std::string start = report.lines == 0 ? "the file is empty" : "no vertex and no edge";
      const bool unknown = !report.diagnostics.empty();
      throw ParseError(
          unknown ? report.diagnostics.front().where : SourceLocation{report.path, 0, 0},
          unknown ? report.diagnostics.front().token : "",
          start + "; expected a pose graph in g2o, TORO or PyFG format");
    }
    const bool toro = counts_[static_cast<std::size_t>(Tag::vertex2)] +
                          counts_[static_cast<std::size_t>(Tag::vertex3)] +
                          counts_[static_cast<std::size_t>(Tag::edge2)] +
                          counts_[static_cast<std::size_t>(Tag::edge3)] >
                      0;
    report.format = named_ ? "pyfg" : untagged_ ? "edge-rows" : toro ? "toro" : "g2o";
  }

  TextReader& text_;
  const ReadOptions& options_;
  FileDraft file_;
  PoseFields fields_;
  bool untagged_;  // every line is an EDGE_SE2 without its tag
  bool named_;     // PyFG: time stamps, names for ids, covariances
  std::size_t kept_bytes_ = 0;
  bool left_out_ = false;  // more lines than are kept
  std::array<std::uint64_t, kTags.size()> counts_{};
};

}  // namespace

std::function<FileDraft()> line_reader(TextReader& reader, FileFormat format,
                                       const ReadOptions& options) {
  auto lines = std::make_shared<PoseGraphReader>(reader, format, options);
  return [lines] { return lines->one_line(); };
}

FileDraft read_draft(TextReader& reader, FileFormat format, const ReadOptions& options) {
  if (format == FileFormat::irl) return read_irl(reader, options);
  if (format == FileFormat::jrl) return read_jrl(reader, options);
  return PoseGraphReader(reader, format, options).run();
}

}  // namespace isotherm::slam::detail
