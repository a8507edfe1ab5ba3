#include "isotherm/network/io/range_rows.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include "isotherm/base/text_reader.hpp"

namespace isotherm::network {
namespace {

using Tokens = std::vector<std::string_view>;

constexpr std::size_t kFlightColumns = 21;  // 3, and 6 of diagnostics for each of 3 messages

bool is_positive(std::string_view token) {
  double value = 0.0;
  return parse_number(token, value) && value > 0.0;
}

// A whole number, perhaps written as 2.0e+000.
bool is_whole(std::string_view token) {
  double value = 0.0;
  return parse_number(token, value) && value >= 0.0 && value == std::floor(value);
}

// Vertices are counted from 1.
bool is_interval(const Tokens& tokens) {
  std::uint64_t i = 0;
  std::uint64_t j = 0;
  double lower = 0.0;
  double upper = 0.0;
  double number = 0.0;
  return tokens.size() >= 4 && parse_unsigned(tokens[0], i) && parse_unsigned(tokens[1], j) &&
         parse_number(tokens[2], lower) && parse_number(tokens[3], upper) && i > 0 && j > 0 &&
         i != j && lower >= 0.0 && lower <= upper && upper > 0.0 &&
         (tokens.size() == 4 || !parse_number(tokens[4], number));
}

bool is_beacon(const Tokens& tokens) {
  double time = 0.0;
  std::uint64_t whole = 0;
  return tokens.size() == 4 && parse_number(tokens[0], time) && !parse_unsigned(tokens[0], whole) &&
         is_whole(tokens[1]) && is_whole(tokens[2]) && tokens[1] != tokens[2] &&
         is_positive(tokens[3]);
}

bool is_flight_time(const Tokens& tokens) {
  std::uint64_t node = 0;
  return tokens.size() == kFlightColumns && is_positive(tokens[0]) &&
         parse_unsigned(tokens[1], node) && parse_unsigned(tokens[2], node) &&
         tokens[1] != tokens[2];
}

template <class Predicate>
bool all_rows(std::string_view text, const Predicate& is_row) {
  std::size_t rows = 0;
  while (!text.empty()) {
    const auto newline = text.find('\n');
    if (newline == std::string_view::npos && rows > 0) break;
    const auto tokens = split(text.substr(0, newline), " \t\r");
    if (!tokens.empty() && tokens.front().front() != '#') {
      if (!is_row(tokens)) return false;
      ++rows;
    }
    if (newline == std::string_view::npos) break;
    text.remove_prefix(newline + 1);
  }
  return rows > 0;
}

}  // namespace

RangeRows detect_range_rows(std::string_view text) {
  if (all_rows(text, is_interval)) return RangeRows::intervals;
  if (all_rows(text, is_beacon)) return RangeRows::beacons;
  if (all_rows(text, is_flight_time)) return RangeRows::flight_times;
  return RangeRows::none;
}

}  // namespace isotherm::network
