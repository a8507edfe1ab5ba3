#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "isotherm/base/text_reader.hpp"

namespace isotherm {

/// Reads comma-separated rows, with or without a line of column names.
///
/// The first row that is neither empty nor a comment (#) is the header if its
/// first field is no number. Blanks around a field are dropped; fields are not
/// quoted.
class CsvReader {
 public:
  /// @throws FileError if the path cannot be opened, ParseError if the first row has other
  ///   separators than commas.
  explicit CsvReader(const std::string& path) : CsvReader(TextReader(path)) {}
  explicit CsvReader(TextReader reader);

  bool has_header() const noexcept { return !header_.empty(); }

  /// Position of a column by name; where there is no header, `position`.
  /// @throws ParseError if the header lacks the name.
  std::size_t column(std::string_view name, std::size_t position) const;

  /// Whether the header has the name.
  std::optional<std::size_t> find_column(std::string_view name) const;

  /// Goes to the next row; false at the end of the input.
  /// @throws ParseError if a row is shorter or longer than the header.
  bool next_row();

  std::size_t field_count() const noexcept { return fields_.size(); }
  std::uint64_t line_number() const noexcept { return reader_.line_number(); }
  const std::string& path() const noexcept { return reader_.path(); }

  /// The field in `column` of the current row; `what` names it in messages.
  /// @throws ParseError if there is none or it is not of that kind.
  std::string_view text(std::size_t column, std::string_view what) const;
  double number(std::size_t column, std::string_view what) const;
  std::uint64_t unsigned_integer(std::size_t column, std::string_view what) const;

  /// @throws ParseError at the field in `column`.
  [[noreturn]] void fail(std::size_t column, const std::string& problem) const;

 private:
  bool next_content_line();
  void require_commas() const;
  void split();

  TextReader reader_;
  std::vector<std::string> header_;
  std::vector<std::string_view> fields_;
  bool first_row_pending_ = false;
};

}  // namespace isotherm
