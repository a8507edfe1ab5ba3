#include "isotherm/base/csv.hpp"

#include <algorithm>
#include <utility>

namespace isotherm {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return text.substr(text.size());
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

CsvReader::CsvReader(TextReader reader) : reader_(std::move(reader)) {
  if (!next_content_line()) return;
  require_commas();
  double number = 0.0;
  if (parse_number(fields_.front(), number)) {
    first_row_pending_ = true;
  } else {
    header_.assign(fields_.begin(), fields_.end());
    fields_.clear();
  }
}

// A row with other separators would be taken for one field, and the first row for names.
void CsvReader::require_commas() const {
  const auto first = reader_.line();
  const bool semicolons = first.find(';') != std::string_view::npos;
  const bool blanks =
      fields_.size() == 1 && fields_.front().find_first_of(" \t") != std::string_view::npos;
  if (!semicolons && !blanks) return;
  constexpr std::size_t kShown = 60;
  throw ParseError({reader_.path(), line_number(), 0}, std::string(first.substr(0, kShown)),
                   std::string("fields are separated by ") +
                       (semicolons ? "semicolons" : "blanks") + "; expected commas");
}

// Goes to the next line that is neither empty nor a comment.
bool CsvReader::next_content_line() {
  while (reader_.next_line()) {
    const auto line = trimmed(reader_.line());
    if (line.empty() || line.front() == '#') continue;
    split();
    return true;
  }
  fields_.clear();
  return false;
}

void CsvReader::split() {
  fields_.clear();
  std::string_view rest = reader_.line();
  while (true) {
    const auto comma = rest.find(',');
    fields_.push_back(trimmed(rest.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    rest.remove_prefix(comma + 1);
  }
}

std::optional<std::size_t> CsvReader::find_column(std::string_view name) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found == header_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header_.begin());
}

std::size_t CsvReader::column(std::string_view name, std::size_t position) const {
  if (!has_header()) return position;
  const auto found = find_column(name);
  if (!found) {
    throw ParseError({reader_.path(), 0, 0}, "",
                     "expected a column named '" + std::string(name) + "'");
  }
  return *found;
}

bool CsvReader::next_row() {
  if (std::exchange(first_row_pending_, false)) return true;
  if (!next_content_line()) return false;
  if (has_header() && fields_.size() != header_.size()) {
    throw ParseError({reader_.path(), line_number(), 0}, "",
                     "expected " + std::to_string(header_.size()) +
                         " fields as in the header, found " + std::to_string(fields_.size()));
  }
  return true;
}

std::string_view CsvReader::text(std::size_t column, std::string_view what) const {
  if (column >= fields_.size()) {
    throw ParseError({reader_.path(), line_number(), 0}, "",
                     "expected " + std::string(what) + " in field " + std::to_string(column + 1) +
                         ", found " + std::to_string(fields_.size()) + " fields");
  }
  return fields_[column];
}

double CsvReader::number(std::size_t column, std::string_view what) const {
  double value = 0.0;
  if (!parse_number(text(column, what), value)) {
    fail(column, "expected " + std::string(what) + ", a finite number");
  }
  return value;
}

std::uint64_t CsvReader::unsigned_integer(std::size_t column, std::string_view what) const {
  std::uint64_t value = 0;
  if (!parse_unsigned(text(column, what), value)) {
    fail(column, "expected " + std::string(what) + ", an integer in [0, 2^64)");
  }
  return value;
}

void CsvReader::fail(std::size_t column, const std::string& problem) const {
  const auto& field = fields_.at(column);
  const auto offset = static_cast<std::uint64_t>(field.data() - reader_.line().data());
  throw ParseError({reader_.path(), line_number(), offset + 1}, std::string(field), problem);
}

}  // namespace isotherm
