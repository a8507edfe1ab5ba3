#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "isotherm/base/csv.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"

namespace isotherm::spectral {
namespace {

constexpr std::string_view kMatrixMarket = "%%MatrixMarket";
// The ends of all edges must be countable with an Index.
constexpr std::size_t kMostEdges = std::numeric_limits<Index>::max() / 2;

struct RawEdge {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
  double weight = 1.0;
};

bool usable_weight(double weight) { return std::isfinite(weight) && weight > 0.0; }

constexpr const char* kExpectedWeight = "expected a weight, finite and positive";

// Positions for ids: ascending, without gaps.
GraphFile build_graph(const std::vector<RawEdge>& raw, ReadReport report) {
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

GraphFile finish_edge_list(std::vector<RawEdge> edges, ReadReport report, std::uint64_t lines) {
  report.lines = lines;
  report.records["edge"] = edges.size();
  check_edge_count(report, edges.size());
  if (edges.empty()) {
    throw ParseError({report.path, 0, 0}, "",
                     "no edge; expected rows of from, to and weight, or a MatrixMarket matrix");
  }
  return build_graph(edges, std::move(report));
}

constexpr const char* kHowToJoin =
    ", not edges; 'isotherm edges' joins points by --neighbours or --radius";

// Coordinates in place of numbers of vertices.
void require_vertices(const CsvReader& csv, std::size_t from) {
  const auto field = csv.text(from, "the first vertex");
  double coordinate = 0.0;
  std::uint64_t vertex = 0;
  if (!parse_unsigned(field, vertex) && parse_number(field, coordinate)) {
    csv.fail(from,
             std::string("expected the number of a vertex; these look like points") + kHowToJoin);
  }
}

GraphFile read_comma_list(TextReader& text, ReadReport report) {
  CsvReader csv(std::move(text));
  if (csv.find_column("x") && !csv.find_column("from")) {
    throw ParseError({report.path, 0, 0}, "x", std::string("these are points") + kHowToJoin);
  }
  const auto from = csv.column("from", 0);
  const auto to = csv.column("to", 1);
  const auto named_weight = csv.find_column("weight");
  std::vector<RawEdge> edges;
  while (csv.next_row()) {
    if (edges.empty()) require_vertices(csv, from);
    RawEdge edge{csv.unsigned_integer(from, "the first vertex"),
                 csv.unsigned_integer(to, "the second vertex"), 1.0};
    const bool weighted = csv.has_header() ? named_weight.has_value() : csv.field_count() > 2;
    if (weighted) {
      const auto column = named_weight.value_or(2);
      edge.weight = csv.number(column, "a weight");
      if (!usable_weight(edge.weight)) csv.fail(column, kExpectedWeight);
    }
    edges.push_back(edge);
  }
  return finish_edge_list(std::move(edges), std::move(report), csv.line_number());
}

bool has_names(std::string_view line) {
  const auto names = split(line, " \t\r");
  return names.size() > 1 && names[0] == "from" && names[1] == "to" &&
         (names.size() == 2 || (names.size() == 3 && names[2] == "weight"));
}

GraphFile read_blank_list(TextReader& text, ReadReport report) {
  std::vector<RawEdge> edges;
  bool first = true;
  while (text.next_line()) {
    if (text.at_line_end() || text.line().starts_with('#') || text.line().starts_with('%')) {
      continue;
    }
    if (std::exchange(first, false) && has_names(text.line())) continue;
    RawEdge edge{text.unsigned_integer("the first vertex"),
                 text.unsigned_integer("the second vertex"), 1.0};
    if (!text.at_line_end()) {
      edge.weight = text.number("a weight");
      if (!usable_weight(edge.weight)) text.fail(kExpectedWeight);
    }
    text.expect_line_end();
    edges.push_back(edge);
  }
  return finish_edge_list(std::move(edges), std::move(report), text.line_number());
}

class MatrixMarketReader {
 public:
  MatrixMarketReader(TextReader& text, const ReadOptions& options, ReadReport report)
      : text_(text), options_(options), report_(std::move(report)) {}

  GraphFile run() {
    read_banner();
    read_sizes();
    while (next_content_line()) read_entry();
    if (count_ != entry_count_) {
      throw ParseError(
          {text_.path(), 0, 0}, "",
          "expected " + std::to_string(entry_count_) + " entries, found " + std::to_string(count_));
    }
    check_vertex_count();
    merge_triangles();
    report_.lines = text_.line_number();
    report_.records["entry"] = count_;
    return result();
  }

 private:
  void read_banner() {
    text_.next_line();
    text_.word();
    expect_word("matrix");
    expect_word("coordinate");
    const auto field = lower(text_.word("real, integer or pattern"));
    if (field != "real" && field != "integer" && field != "pattern") {
      text_.fail("expected real, integer or pattern");
    }
    pattern_ = field == "pattern";
    const auto symmetry = lower(text_.word("symmetric or general"));
    if (symmetry != "symmetric" && symmetry != "general") {
      text_.fail("expected symmetric or general");
    }
    general_ = symmetry == "general";
    text_.expect_line_end();
  }

  void read_sizes() {
    if (!next_content_line()) {
      throw ParseError({text_.path(), text_.line_number(), 0}, "", "expected a line of sizes");
    }
    vertex_count_ = text_.unsigned_integer("the number of rows");
    if (text_.unsigned_integer("the number of columns") != vertex_count_) {
      text_.fail("expected as many columns as rows");
    }
    if (vertex_count_ > std::numeric_limits<Index>::max() - 1) text_.fail("too many rows");
    entry_count_ = text_.unsigned_integer("the number of entries");
    text_.expect_line_end();
  }

  void read_entry() {
    if (count_ == entry_count_) {
      throw ParseError({text_.path(), text_.line_number(), 0}, "", "more entries than stated");
    }
    check_edge_count(report_, ++count_);
    const auto row = index("a row");
    const auto column = index("a column");
    double weight = 1.0;
    if (!pattern_) weight = text_.number("a weight");
    const bool usable = usable_weight(weight);
    if (row == column) {
      add_note("diagonal entry", "diagonal entry; left out");
    } else if (weight == 0.0) {
      add_note("zero entry", "entry that is zero; left out");
    } else if (!usable) {
      text_.fail(kExpectedWeight);
    } else {
      entries_.push_back({std::max(row, column), std::min(row, column), row > column, weight,
                          text_.line_number()});
    }
    text_.expect_line_end();
  }

  std::uint64_t index(std::string_view what) {
    const auto value = text_.unsigned_integer(what);
    if (value < 1 || value > vertex_count_) {
      text_.fail("expected " + std::string(what) + " in [1, " + std::to_string(vertex_count_) +
                 "]");
    }
    return value;
  }

  // Memory for vertices must be earned by entries.
  void check_vertex_count() const {
    constexpr std::uint64_t kFree = 1'000'000;
    constexpr std::uint64_t kPerEntry = 64;
    if (vertex_count_ > kFree + kPerEntry * count_) {
      throw ParseError({text_.path(), 0, 0}, "",
                       "claims " + std::to_string(vertex_count_) + " rows for " +
                           std::to_string(count_) + " entries");
    }
  }

  // Where the whole matrix is stored, joins (i, j) with (j, i).
  void merge_triangles() {
    if (!general_) return;
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
    for (std::uint64_t id = 1; id <= vertex_count_; ++id) file.ids.push_back(id);
    file.graph = WeightedGraph(static_cast<Index>(vertex_count_), std::move(edges));
    return file;
  }

  bool next_content_line() {
    while (text_.next_line()) {
      if (!text_.at_line_end() && !text_.line().starts_with('%')) return true;
    }
    return false;
  }

  static std::string lower(std::string_view word) {
    std::string text(word);
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
  }

  void expect_word(const std::string& wanted) {
    if (lower(text_.word(wanted)) != wanted) text_.fail("expected '" + wanted + "'");
  }

  void add_note(const std::string& kind, const std::string& message) {
    report_.add_note({kind, text_.location(), "", message});
  }

  TextReader& text_;
  const ReadOptions& options_;
  ReadReport report_;
  bool pattern_ = false;
  bool general_ = false;
  std::uint64_t vertex_count_ = 0;
  std::uint64_t entry_count_ = 0;  // as stated
  std::uint64_t count_ = 0;
  std::vector<Entry> entries_;
};

// Whether the first row that is no comment has a comma.
bool separated_by_commas(std::string_view start) {
  while (!start.empty()) {
    const auto newline = start.find('\n');
    const auto line = start.substr(0, newline);
    const auto first = line.find_first_not_of(" \t\r");
    if (first != std::string_view::npos && line[first] != '#') {
      return line.find(',') != std::string_view::npos;
    }
    if (newline == std::string_view::npos) break;
    start.remove_prefix(newline + 1);
  }
  return false;
}

}  // namespace

GraphFile read_graph(TextReader& reader, const ReadOptions& options) {
  options.validate();
  ReadReport report;
  report.path = reader.path();
  const auto start = reader.peek();
  if (start.starts_with(kMatrixMarket)) {
    report.format = "matrix-market";
    return MatrixMarketReader(reader, options, std::move(report)).run();
  }
  report.format = "edges";
  if (separated_by_commas(start)) return read_comma_list(reader, std::move(report));
  return read_blank_list(reader, std::move(report));
}

GraphFile read_graph(const std::string& path, const ReadOptions& options) {
  TextReader reader(path);
  return read_graph(reader, options);
}

}  // namespace isotherm::spectral
