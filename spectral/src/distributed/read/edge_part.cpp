#include "distributed/read/edge_part.hpp"

#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "distributed/read/file_part.hpp"
#include "distributed/read/pose_rows.hpp"
#include "graph/binary_graph.hpp"
#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

using spectral::detail::FileEdge;
constexpr const char* kNoEdge =
    "no edge; expected rows of from, to and weight, or a MatrixMarket matrix";
constexpr std::size_t kHead = TextReader::kLongestLine;  // bytes in which the first row stands

enum class Form { commas, blanks, matrix, poses, binary };

/// What comes before the rows that ranks share, as each of them is given it to begin with.
struct Head {
  Form form = Form::blanks;
  std::string text;
  std::uint64_t end = 0;    // offset
  std::uint64_t lines = 0;  // before `end`
};

/// The lines of a head, one after the other.
class HeadLines {
 public:
  explicit HeadLines(const std::string& start) : start_(start) {
    if (start_.starts_with("\xEF\xBB\xBF")) end_ = 3;
  }
  /// The next line that is neither empty nor begins with one of `comment`.
  bool next(std::string_view comment) {
    while (end_ < start_.size()) {
      const auto newline = std::min(start_.find('\n', end_), start_.size() - 1);
      line_ = std::string_view(start_).substr(end_, newline + 1 - end_);
      end_ = newline + 1;
      ++count_;
      const auto first = line_.find_first_not_of(" \t\r\n");
      if (first != line_.npos && comment.find(line_[first]) == comment.npos) return true;
    }
    return false;
  }
  std::string_view line() const { return line_; }
  std::uint64_t end() const { return end_; }
  std::uint64_t count() const { return count_; }

 private:
  const std::string& start_;
  std::size_t end_ = 0;
  std::uint64_t count_ = 0;
  std::string_view line_;
};

Head matrix_head(HeadLines lines, const std::string& path) {
  lines.next("");
  Head head{Form::matrix, std::string(lines.line())};
  if (!lines.next("%")) throw ParseError({path, 0, 0}, "", "expected a line of sizes");
  head.text += lines.line();
  head.end = lines.end();
  head.lines = lines.count();
  return head;
}

Head head_of(const ByteFile& file) {
  const auto start = file.start(kHead);
  if (start.starts_with("\x1f\x8b")) {
    throw FileError(file.path(),
                    "is compressed, and cannot be read in parts; decompress it, or make a binary "
                    "graph of it by 'isotherm convert'");
  }
  if (start.starts_with(spectral::detail::kBinaryGraph)) return {Form::binary};
  HeadLines lines(start);
  if (start.starts_with(spectral::detail::kMatrixMarket)) return matrix_head(lines, file.path());
  if (!lines.next("#%")) throw ParseError({file.path(), 0, 0}, "", kNoEdge);
  if (is_pose_record(lines.line())) return {Form::poses};
  const bool commas = spectral::detail::separated_by_commas(start);
  Head head{commas ? Form::commas : Form::blanks, std::string(lines.line()), lines.end(),
            lines.count()};
  if (!head.text.ends_with('\n')) head.text += '\n';
  return head;
}

/// The rows of one rank's part, whatever their form.
struct Rows {
  std::vector<FileEdge> edges;
  std::vector<std::uint64_t> vertices;  // with lines of their own
  std::uint64_t vertex_count = 0;       // as a matrix states it
  std::uint64_t entry_count = 0;        // the same
  std::int64_t entries = 0;             // of a matrix, with those that are no edges
  std::map<std::string, std::int64_t> notes;
};

/// Rows that each rank begins with the first one of the file, which counts once.
template <class List>
Rows rows_of_list(List list, bool first) {
  Rows rows;
  FileEdge edge;
  bool more = list.next(edge);
  if (more && !list.has_names() && !first) more = list.next(edge);
  for (; more; more = list.next(edge)) rows.edges.push_back(edge);
  return rows;
}

Rows rows_of_matrix(TextReader text) {
  spectral::detail::MatrixRows matrix(text);
  if (matrix.general()) {
    throw ParseError({text.path(), 1, 0}, "",
                     "a matrix that is stored in full cannot be read in parts; 'isotherm convert' "
                     "writes one triangle of it");
  }
  Rows rows;
  rows.vertex_count = matrix.vertex_count();
  rows.entry_count = matrix.entry_count();
  for (spectral::detail::MatrixRows::Entry entry; matrix.next(entry); ++rows.entries) {
    if (entry.row == entry.column) {
      ++rows.notes["diagonal entry"];
    } else if (entry.weight == 0.0) {
      ++rows.notes["zero entry"];
    } else {
      rows.edges.push_back(
          {std::min(entry.row, entry.column), std::max(entry.row, entry.column), entry.weight});
    }
  }
  return rows;
}

Rows rows_of_poses(TextReader text) {
  PoseRows poses(std::move(text));
  Rows rows;
  for (FileEdge edge; poses.next(edge);) rows.edges.push_back(edge);
  rows.vertices = std::move(poses.vertices());
  return rows;
}

Rows parse(Form form, TextReader text, bool first) {
  switch (form) {
    case Form::commas:
      return rows_of_list(spectral::detail::CommaRows(std::move(text)), first);
    case Form::blanks:
      return rows_of_list(spectral::detail::BlankRows(std::move(text)), first);
    case Form::matrix:
      return rows_of_matrix(std::move(text));
    case Form::poses:
    case Form::binary:
      break;
  }
  return rows_of_poses(std::move(text));
}

/// Lines are counted only where one of them is at fault.
Rows read_rows(const Comm& comm, const ByteFile& file, const Head& head) {
  std::uint64_t begin = 0, end = 0;
  Rows rows;
  bool failed = false;
  const auto read = [&](std::uint64_t lines_before) {
    TextReader text(file.path(), file.part(head.text, begin, end), lines_before);
    rows = parse(head.form, std::move(text), comm.rank == 0);
  };
  together(comm, [&] {
    const Blocks bytes(comm, static_cast<std::int64_t>(file.size() - head.end));
    begin = file.line_start(head.end + static_cast<std::uint64_t>(bytes.begin(comm.rank)));
    end = file.line_start(head.end + static_cast<std::uint64_t>(bytes.end(comm.rank)));
    try {
      read(0);
    } catch (const ParseError&) {
      failed = true;
    }
  });
  if (!any(comm, failed)) return rows;
  std::uint64_t lines = 0;
  together(comm, [&] { lines = file.count_lines(begin, end); });
  const auto before = sum_before(comm, static_cast<std::int64_t>(lines));
  const auto in_head = std::count(head.text.begin(), head.text.end(), '\n');
  together(comm, [&] {
    if (failed) read(head.lines + static_cast<std::uint64_t>(before - in_head));
  });
  return rows;
}

ReadReport report_of(const Comm& comm, const std::string& path, Form form, const Rows& rows) {
  constexpr std::array<const char*, 5> kNames = {"edges", "edges", "matrix-market", "g2o",
                                                 "binary"};
  ReadReport report;
  report.path = path;
  report.format = kNames[static_cast<std::size_t>(form)];
  const auto edges = sum(comm, static_cast<std::int64_t>(rows.edges.size()));
  report.records["edge"] = static_cast<std::uint64_t>(edges);
  for (const char* kind : {"diagonal entry", "zero entry"}) {
    const auto mine = rows.notes.find(kind);
    const auto count = sum(comm, mine == rows.notes.end() ? std::int64_t{0} : mine->second);
    if (count > 0) report.notes[kind] = static_cast<std::uint64_t>(count);
  }
  return report;
}

/// Its vertices are numbered from 1.
EdgePart matrix_part(const Comm& comm, const Rows& rows, const std::string& path) {
  const auto found = static_cast<std::uint64_t>(sum(comm, rows.entries));
  if (found != rows.entry_count) {
    throw ParseError({path, 0, 0}, "",
                     "expected " + std::to_string(rows.entry_count) + " entries, found " +
                         std::to_string(found));
  }
  // Memory for vertices must be earned by entries.
  constexpr std::uint64_t kFree = 1'000'000, kPerEntry = 64;
  if (rows.vertex_count > kFree + kPerEntry * found) {
    throw ParseError({path, 0, 0}, "",
                     "claims " + std::to_string(rows.vertex_count) + " rows for " +
                         std::to_string(found) + " entries");
  }
  EdgePart part;
  part.blocks = Blocks(comm, static_cast<std::int64_t>(rows.vertex_count));
  for (auto v = part.blocks.begin(comm.rank); v < part.blocks.end(comm.rank); ++v) {
    part.ids.push_back(static_cast<std::uint64_t>(v) + 1);
  }
  for (const auto& edge : rows.edges) {
    part.edges.push_back(
        {static_cast<Index>(edge.from - 1), static_cast<Index>(edge.to - 1), edge.weight});
  }
  return part;
}

template <class Item>
std::vector<Item> read_items(const ByteFile& file, std::uint64_t offset, const Blocks& blocks,
                             int rank) {
  std::vector<Item> items(static_cast<std::size_t>(blocks.end(rank) - blocks.begin(rank)));
  const std::span bytes(reinterpret_cast<char*>(items.data()), items.size() * sizeof(Item));
  const auto begin = static_cast<std::uint64_t>(blocks.begin(rank)) * sizeof(Item);
  if (file.read(offset + begin, bytes) < bytes.size()) {
    throw FileError(file.path(), "became shorter while it was read");
  }
  return items;
}

EdgePart binary_part(const Comm& comm, const ByteFile& file) {
  EdgePart part;
  part.report.path = file.path();
  part.report.format = "binary";
  spectral::detail::BinaryHead head;
  spectral::detail::BinaryLayout layout;
  Blocks edge_blocks;
  std::vector<spectral::detail::BinaryEdge> raw;
  together(comm, [&] {
    const auto bytes = file.start(sizeof(head));
    if (bytes.size() < sizeof(head)) {
      throw ParseError({file.path(), 0, 0}, "", "ends within its head");
    }
    std::memcpy(&head, bytes.data(), sizeof(head));
    layout = spectral::detail::binary_layout(head, file.path());
    if (file.size() != layout.end) {
      throw ParseError({file.path(), 0, 0}, "",
                       "expected " + std::to_string(layout.end) + " bytes, found " +
                           std::to_string(file.size()));
    }
    part.blocks = Blocks(comm, static_cast<std::int64_t>(head.vertex_count));
    edge_blocks = Blocks(comm, static_cast<std::int64_t>(head.edge_count));
    part.ids = read_items<std::uint64_t>(file, layout.ids, part.blocks, comm.rank);
    raw = read_items<spectral::detail::BinaryEdge>(file, layout.edges, edge_blocks, comm.rank);
    const auto first = static_cast<std::uint64_t>(part.blocks.begin(comm.rank));
    // The last number of the rank before.
    std::uint64_t last = 0;
    if (first > 0) {
      file.read(layout.ids + (first - 1) * sizeof(last),
                {reinterpret_cast<char*>(&last), sizeof(last)});
    }
    spectral::detail::check_ids(part.ids, first, last, file.path());
    spectral::detail::check_edges(raw, static_cast<std::uint64_t>(edge_blocks.begin(comm.rank)),
                                  head.vertex_count, file.path());
  });
  part.edges.reserve(raw.size());
  for (const auto& [from, to, weight] : raw) {
    part.edges.push_back({static_cast<Index>(from), static_cast<Index>(to), weight});
  }
  part.report.records["edge"] = head.edge_count;
  return part;
}

}  // namespace

EdgePart read_edge_part(const Comm& comm, const std::string& path, const ReadOptions& options) {
  options.validate();
  std::optional<ByteFile> file;
  Head head;
  together(comm, [&] {
    if (path == "-") throw InvalidArgument("input", "of several ranks cannot be standard input");
    file.emplace(path);
    head = head_of(*file);
  });
  if (head.form == Form::binary) return binary_part(comm, *file);
  auto rows = read_rows(comm, *file, head);
  auto report = report_of(comm, path, head.form, rows);
  if (report.records["edge"] == 0 && head.form != Form::matrix) {
    throw ParseError({path, 0, 0}, "", kNoEdge);
  }
  auto part = head.form == Form::matrix
                  ? matrix_part(comm, rows, path)
                  : number_vertices(comm, std::move(rows.edges), std::move(rows.vertices), path);
  part.report = std::move(report);
  return part;
}

}  // namespace isotherm::spectral::distributed::detail
