#include "isotherm/slam/io/file_format.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "io/incremental/irl_reader.hpp"
#include "io/incremental/jrl_reader.hpp"
#include "isotherm/network/io/range_rows.hpp"

namespace isotherm::slam {
namespace {

bool contains(const std::vector<std::string_view>& tokens, std::string_view wanted) {
  return std::find(tokens.begin(), tokens.end(), wanted) != tokens.end();
}

// A letter and a number, as in A12.
bool is_name(std::string_view token) {
  std::uint64_t number = 0;
  return std::isalpha(static_cast<unsigned char>(token.front())) != 0 &&
         parse_unsigned(token.substr(1), number);
}

// PyFG names its vertices by a letter and a number where g2o has an id, and
// gives a time stamp first (landmarks have none).
bool has_named_vertex(const std::vector<std::string_view>& tokens) {
  double stamp = 0.0;
  if (tokens.size() > 2 && parse_number(tokens[1], stamp)) return is_name(tokens[2]);
  const bool landmark = tokens.front() == "VERTEX_XY" || tokens.front() == "VERTEX_XYZ";
  return landmark && tokens.size() > 1 && is_name(tokens[1]);
}

FileFormat format_of_record(const std::vector<std::string_view>& tokens) {
  const auto tag = tokens.front();
  if (tag == "range2" || tag == "odom2diff") return FileFormat::librsf;
  if (tag == "odom2" || tag == "loop") return FileFormat::places;
  if (tag == "point2") return FileFormat::points;
  const bool known = tag.starts_with("VERTEX") || tag.starts_with("EDGE") || tag == "FIX";
  if (!known) return FileFormat::unknown;
  if (tag == "EDGE_RANGE" || has_named_vertex(tokens)) return FileFormat::pyfg;
  const bool toro = tag == "VERTEX2" || tag == "VERTEX3" || tag == "EDGE2" || tag == "EDGE3";
  return toro ? FileFormat::toro : FileFormat::g2o;
}

FileFormat format_of_header(const std::vector<std::string_view>& names) {
  if (contains(names, "from") && contains(names, "to")) {
    return contains(names, "range") ? FileFormat::ranges : FileFormat::edges;
  }
  if (contains(names, "time") || contains(names, "timestamp")) {
    return names.size() >= 8 ? FileFormat::euroc : FileFormat::planar;
  }
  return FileFormat::unknown;
}

FileFormat format_of_row(const std::vector<std::string_view>& tokens, bool commas) {
  switch (tokens.size()) {
    case 2:
    case 3:
      return FileFormat::edges;
    case 4:
      return FileFormat::planar;
    case 8:
      return commas ? FileFormat::euroc : FileFormat::tum;
    case 11:
      return commas ? FileFormat::euroc : FileFormat::edge_rows;
    case 12:
    case 13:
      return commas ? FileFormat::euroc : FileFormat::kitti;
    default:
      return commas && tokens.size() > 8 ? FileFormat::euroc : FileFormat::unknown;
  }
}

FileFormat format_of_line(std::string_view line) {
  if (line.starts_with("%%MatrixMarket")) return FileFormat::matrix_market;
  if (line.starts_with("#timestamp")) return FileFormat::euroc;
  const auto tokens = split(line, " \t,\r");
  if (tokens.empty() || tokens.front().front() == '#') return FileFormat::unknown;
  const bool commas = line.find(',') != std::string_view::npos;
  double number = 0.0;
  if (parse_number(tokens.front(), number)) return format_of_row(tokens, commas);
  const auto record = format_of_record(tokens);
  return record != FileFormat::unknown || !commas ? record : format_of_header(tokens);
}

// Rows of ranges without tags or names.
FileFormat format_of_rows(std::string_view text) {
  switch (network::detect_range_rows(text)) {
    case network::RangeRows::intervals:
      return FileFormat::intervals;
    case network::RangeRows::beacons:
      return FileFormat::beacons;
    case network::RangeRows::flight_times:
      return FileFormat::flight_times;
    case network::RangeRows::none:
      break;
  }
  return FileFormat::unknown;
}

}  // namespace

FileContent content_of(FileFormat format) {
  switch (format) {
    case FileFormat::g2o:
    case FileFormat::toro:
    case FileFormat::edge_rows:
    case FileFormat::irl:
    case FileFormat::jrl:
    case FileFormat::places:
      return FileContent::pose_graph;
    case FileFormat::pyfg:
    case FileFormat::ranges:
    case FileFormat::librsf:
    case FileFormat::intervals:
    case FileFormat::beacons:
    case FileFormat::flight_times:
      return FileContent::ranges;
    case FileFormat::tum:
    case FileFormat::kitti:
    case FileFormat::euroc:
    case FileFormat::planar:
    case FileFormat::points:
      return FileContent::trajectory;
    case FileFormat::edges:
    case FileFormat::matrix_market:
    case FileFormat::binary_graph:
      return FileContent::graph;
    case FileFormat::unknown:
      break;
  }
  return FileContent::unknown;
}

FileFormat detect_format(TextReader& reader) {
  std::string_view rest = reader.peek();
  if (rest.starts_with("ISOGRAPH")) return FileFormat::binary_graph;
  if (detail::is_jrl(rest)) return FileFormat::jrl;
  if (detail::irl_header(rest)) return FileFormat::irl;
  const auto rows = format_of_rows(rest);
  if (rows != FileFormat::unknown) return rows;
  while (!rest.empty()) {
    const auto newline = rest.find('\n');
    const auto format = format_of_line(rest.substr(0, newline));
    if (format != FileFormat::unknown) return format;
    if (newline == std::string_view::npos) break;
    rest.remove_prefix(newline + 1);
  }
  return FileFormat::unknown;
}

FileFormat require_format(TextReader& reader) {
  const auto format = detect_format(reader);
  if (format != FileFormat::unknown) return format;
  const auto start = reader.peek();
  if (start.empty()) throw ParseError({reader.path(), 0, 0}, "", "the file is empty");
  const auto first = start.substr(0, start.find('\n'));
  const bool semicolons = first.find(';') != std::string_view::npos;
  throw ParseError({reader.path(), 1, 0}, std::string(first),
                   std::string(semicolons ? "fields are separated by semicolons, expected commas"
                                          : "unknown format") +
                       "; expected " + joined_enum_names<FileFormat>(", ").substr(9));
}

}  // namespace isotherm::slam
