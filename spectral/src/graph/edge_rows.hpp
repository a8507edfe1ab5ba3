#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "isotherm/base/csv.hpp"
#include "isotherm/base/text_reader.hpp"

/// The rows of edge lists and matrices, one at a time, whoever makes what of them.
namespace isotherm::spectral::detail {

/// An edge between vertices as a file numbers them.
struct FileEdge {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
  double weight = 1.0;
};

bool usable_weight(double weight);

constexpr const char* kExpectedWeight = "expected a weight, finite and positive";

/// Whether the first row that is no comment has a comma.
bool separated_by_commas(std::string_view start);

/// `from,to[,weight]`, with or without column names.
class CommaRows {
 public:
  /// @throws ParseError if the rows are no edges
  explicit CommaRows(TextReader text);

  bool has_names() const noexcept { return csv_.has_header(); }
  std::uint64_t line_number() const noexcept { return csv_.line_number(); }

  /// False at the end. @throws ParseError
  bool next(FileEdge& edge);

 private:
  void require_vertices() const;

  CsvReader csv_;
  std::size_t from_ = 0;
  std::size_t to_ = 1;
  std::optional<std::size_t> weight_;
  bool first_ = true;
};

/// `from to [weight]`, with or without column names.
class BlankRows {
 public:
  explicit BlankRows(TextReader text) : text_(std::move(text)) {}

  /// Whether the first row had names; known after next().
  bool has_names() const noexcept { return has_names_; }
  std::uint64_t line_number() const noexcept { return text_.line_number(); }

  /// False at the end. @throws ParseError
  bool next(FileEdge& edge);

 private:
  TextReader text_;
  bool first_ = true;
  bool has_names_ = false;
};

constexpr std::string_view kMatrixMarket = "%%MatrixMarket";

/// The entries of a MatrixMarket matrix in coordinate format.
class MatrixRows {
 public:
  struct Entry {
    std::uint64_t row = 0;  // from 1, as the file has it
    std::uint64_t column = 0;
    double weight = 1.0;
    std::uint64_t line = 0;
  };

  /// Reads banner and sizes; `text` must outlive this. @throws ParseError
  explicit MatrixRows(TextReader& text);

  std::uint64_t vertex_count() const noexcept { return vertex_count_; }
  std::uint64_t entry_count() const noexcept { return entry_count_; }  ///< as stated
  bool general() const noexcept { return general_; }                   ///< stored in full

  /// False at the end. A weight off the diagonal is usable or 0. @throws ParseError
  bool next(Entry& entry);

 private:
  void read_banner();
  void read_sizes();
  bool next_content_line();
  std::uint64_t index(std::string_view what);
  void expect_word(std::string_view wanted);

  TextReader& text_;
  bool pattern_ = false;
  bool general_ = false;
  std::uint64_t vertex_count_ = 0;
  std::uint64_t entry_count_ = 0;
};

}  // namespace isotherm::spectral::detail
