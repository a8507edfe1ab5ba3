#include "graph/edge_rows.hpp"

#include <cctype>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr const char* kHowToJoin =
    ", not edges; 'isotherm edges' joins points by --neighbours or --radius";

bool has_edge_names(std::string_view line) {
  const auto names = split(line, " \t\r");
  return names.size() > 1 && names[0] == "from" && names[1] == "to" &&
         (names.size() == 2 || (names.size() == 3 && names[2] == "weight"));
}

std::string lower(std::string_view word) {
  std::string text(word);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

bool usable_weight(double weight) { return std::isfinite(weight) && weight > 0.0; }

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

CommaRows::CommaRows(TextReader text) : csv_(std::move(text)) {
  if (csv_.find_column("x") && !csv_.find_column("from")) {
    throw ParseError({csv_.path(), 0, 0}, "x", std::string("these are points") + kHowToJoin);
  }
  from_ = csv_.column("from", 0);
  to_ = csv_.column("to", 1);
  weight_ = csv_.find_column("weight");
}

// Coordinates in place of numbers of vertices.
void CommaRows::require_vertices() const {
  const auto field = csv_.text(from_, "the first vertex");
  double coordinate = 0.0;
  std::uint64_t vertex = 0;
  if (!parse_unsigned(field, vertex) && parse_number(field, coordinate)) {
    csv_.fail(from_,
              std::string("expected the number of a vertex; these look like points") + kHowToJoin);
  }
}

bool CommaRows::next(FileEdge& edge) {
  if (!csv_.next_row()) return false;
  if (std::exchange(first_, false)) require_vertices();
  edge = {csv_.unsigned_integer(from_, "the first vertex"),
          csv_.unsigned_integer(to_, "the second vertex"), 1.0};
  const bool weighted = csv_.has_header() ? weight_.has_value() : csv_.field_count() > 2;
  if (weighted) {
    const auto column = weight_.value_or(2);
    edge.weight = csv_.number(column, "a weight");
    if (!usable_weight(edge.weight)) csv_.fail(column, kExpectedWeight);
  }
  return true;
}

bool BlankRows::next(FileEdge& edge) {
  while (text_.next_line()) {
    if (text_.at_line_end() || text_.line().starts_with('#') || text_.line().starts_with('%')) {
      continue;
    }
    if (std::exchange(first_, false) && has_edge_names(text_.line())) {
      has_names_ = true;
      continue;
    }
    edge = {text_.unsigned_integer("the first vertex"), text_.unsigned_integer("the second vertex"),
            1.0};
    if (!text_.at_line_end()) {
      edge.weight = text_.number("a weight");
      if (!usable_weight(edge.weight)) text_.fail(kExpectedWeight);
    }
    text_.expect_line_end();
    return true;
  }
  return false;
}

MatrixRows::MatrixRows(TextReader& text) : text_(text) {
  read_banner();
  read_sizes();
}

void MatrixRows::read_banner() {
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

void MatrixRows::read_sizes() {
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

bool MatrixRows::next(Entry& entry) {
  if (!next_content_line()) return false;
  entry = {index("a row"), index("a column"), 1.0, text_.line_number()};
  if (!pattern_) entry.weight = text_.number("a weight");
  const bool needed = entry.row != entry.column && entry.weight != 0.0;
  if (needed && !usable_weight(entry.weight)) text_.fail(kExpectedWeight);
  text_.expect_line_end();
  return true;
}

bool MatrixRows::next_content_line() {
  while (text_.next_line()) {
    if (!text_.at_line_end() && !text_.line().starts_with('%')) return true;
  }
  return false;
}

std::uint64_t MatrixRows::index(std::string_view what) {
  const auto value = text_.unsigned_integer(what);
  if (value < 1 || value > vertex_count_) {
    text_.fail("expected " + std::string(what) + " in [1, " + std::to_string(vertex_count_) + "]");
  }
  return value;
}

void MatrixRows::expect_word(std::string_view wanted) {
  if (lower(text_.word(wanted)) != wanted) {
    text_.fail("expected '" + std::string(wanted) + "'");
  }
}

}  // namespace isotherm::spectral::detail
