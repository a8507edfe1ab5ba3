#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "graph/binary_graph.hpp"
#include "graph/edge_rows.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"

namespace isotherm::spectral {
namespace {

// The ends of all edges must be countable with an Index.
constexpr std::size_t kMostEdges = std::numeric_limits<Index>::max() / 2;

using detail::FileEdge;

// Positions for ids: ascending, without gaps.
GraphFile build_graph(const std::vector<FileEdge>& raw, ReadReport report) {
  GraphFile file;
  file.report = std::move(report);
  for (const auto& edge : raw) {
    file.ids.push_back(edge.from);
    file.ids.push_back(edge.to);
  }
  std::sort(file.ids.begin(), file.ids.end());
  file.ids.erase(std::unique(file.ids.begin(), file.ids.end()), file.ids.end());
  file.ids.shrink_to_fit();
  const auto position = [&](std::uint64_t id) {
    return static_cast<Index>(std::lower_bound(file.ids.begin(), file.ids.end(), id) -
                              file.ids.begin());
  };
  std::vector<WeightedEdge> edges;
  edges.reserve(raw.size());
  for (const auto& edge : raw) {
    edges.push_back({position(edge.from), position(edge.to), edge.weight});
  }
  file.graph = WeightedGraph(static_cast<Index>(file.ids.size()), std::move(edges));
  return file;
}

void check_edge_count(const ReadReport& report, std::size_t count) {
  if (count > kMostEdges) {
    throw ParseError({report.path, 0, 0}, "", "more than " + std::to_string(kMostEdges) + " edges");
  }
}

GraphFile finish_edge_list(std::vector<FileEdge> edges, ReadReport report, std::uint64_t lines) {
  report.lines = lines;
  report.records["edge"] = edges.size();
  check_edge_count(report, edges.size());
  if (edges.empty()) {
    throw ParseError({report.path, 0, 0}, "",
                     "no edge; expected rows of from, to and weight, or a MatrixMarket matrix");
  }
  return build_graph(edges, std::move(report));
}

template <class Rows>
GraphFile read_list(Rows rows, ReadReport report) {
  std::vector<FileEdge> edges;
  for (FileEdge edge; rows.next(edge);) edges.push_back(edge);
  return finish_edge_list(std::move(edges), std::move(report), rows.line_number());
}

class MatrixMarketReader {
 public:
  MatrixMarketReader(TextReader& text, const ReadOptions& options, ReadReport report)
      : text_(text), rows_(text), options_(options), report_(std::move(report)) {}

  GraphFile run() {
    for (detail::MatrixRows::Entry entry; rows_.next(entry);) take(entry);
    if (count_ != rows_.entry_count()) {
      throw ParseError({text_.path(), 0, 0}, "",
                       "expected " + std::to_string(rows_.entry_count()) + " entries, found " +
                           std::to_string(count_));
    }
    check_vertex_count();
    merge_triangles();
    report_.lines = text_.line_number();
    report_.records["entry"] = count_;
    return result();
  }

 private:
  void take(const detail::MatrixRows::Entry& entry) {
    const auto& [row, column, weight, line] = entry;
    if (count_ == rows_.entry_count()) {
      throw ParseError({text_.path(), line, 0}, "", "more entries than stated");
    }
    check_edge_count(report_, ++count_);
    if (row == column) {
      add_note("diagonal entry", line, "diagonal entry; left out");
    } else if (weight == 0.0) {
      add_note("zero entry", line, "entry that is zero; left out");
    } else {
      entries_.push_back(
          {std::max(row, column), std::min(row, column), row > column, weight, line});
    }
  }

  // Memory for vertices must be earned by entries.
  void check_vertex_count() const {
    constexpr std::uint64_t kFree = 1'000'000;
    constexpr std::uint64_t kPerEntry = 64;
    if (rows_.vertex_count() > kFree + kPerEntry * count_) {
      throw ParseError({text_.path(), 0, 0}, "",
                       "claims " + std::to_string(rows_.vertex_count()) + " rows for " +
                           std::to_string(count_) + " entries");
    }
  }

  // Where the whole matrix is stored, joins (i, j) with (j, i).
  void merge_triangles() {
    if (!rows_.general()) return;
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return std::tie(a.row, a.column) < std::tie(b.row, b.column);
    });
    std::vector<Entry> merged;
    for (std::size_t k = 0; k < entries_.size(); k += 2) {
      const Entry& first = entries_[k];
      const bool paired = k + 1 < entries_.size() && entries_[k + 1].row == first.row &&
                          entries_[k + 1].column == first.column &&
                          entries_[k + 1].lower != first.lower;
      if (!paired) fail_asymmetric(first);
      merged.push_back(average(first, entries_[k + 1]));
    }
    entries_ = std::move(merged);
  }

  struct Entry {
    std::uint64_t row = 0;  // row > column
    std::uint64_t column = 0;
    bool lower = true;  // whether the file has it below the diagonal
    double weight = 1.0;
    std::uint64_t line = 0;
  };

  Entry average(const Entry& a, const Entry& b) {
    constexpr double kRounding = 1e-6;
    if (a.weight == b.weight) return a;
    if (std::abs(a.weight - b.weight) > kRounding * std::max(a.weight, b.weight)) {
      fail_asymmetric(b);
    }
    report_.add_repair(options_, {"matrix symmetrised",
                                  {text_.path(), b.line, 0},
                                  format_number(b.weight),
                                  "matrix is symmetric only up to rounding; averaged"});
    Entry mean = a;
    mean.weight = 0.5 * a.weight + 0.5 * b.weight;
    return mean;
  }

  [[noreturn]] void fail_asymmetric(const Entry& entry) const {
    throw ParseError({text_.path(), entry.line, 0}, format_number(entry.weight),
                     "matrix is not symmetric");
  }

  GraphFile result() {
    GraphFile file;
    file.report = std::move(report_);
    std::vector<WeightedEdge> edges;
    edges.reserve(entries_.size());
    for (const auto& entry : entries_) {
      edges.push_back(
          {static_cast<Index>(entry.column - 1), static_cast<Index>(entry.row - 1), entry.weight});
    }
    for (std::uint64_t id = 1; id <= rows_.vertex_count(); ++id) file.ids.push_back(id);
    file.graph = WeightedGraph(static_cast<Index>(rows_.vertex_count()), std::move(edges));
    return file;
  }

  void add_note(const std::string& kind, std::uint64_t line, const std::string& message) {
    report_.add_note({kind, {text_.path(), line, 0}, "", message});
  }

  TextReader& text_;
  detail::MatrixRows rows_;
  const ReadOptions& options_;
  ReadReport report_;
  std::uint64_t count_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace

GraphFile read_graph(TextReader& reader, const ReadOptions& options) {
  options.validate();
  ReadReport report;
  report.path = reader.path();
  const auto start = reader.peek();
  if (start.starts_with(detail::kMatrixMarket)) {
    report.format = "matrix-market";
    return MatrixMarketReader(reader, options, std::move(report)).run();
  }
  if (start.starts_with(detail::kBinaryGraph)) {
    report.format = "binary";
    return detail::read_binary_graph(reader, std::move(report));
  }
  report.format = "edges";
  if (detail::separated_by_commas(start)) {
    return read_list(detail::CommaRows(std::move(reader)), std::move(report));
  }
  return read_list(detail::BlankRows(std::move(reader)), std::move(report));
}

GraphFile read_graph(const std::string& path, const ReadOptions& options) {
  TextReader reader(path);
  return read_graph(reader, options);
}

}  // namespace isotherm::spectral
