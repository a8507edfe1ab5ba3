#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>

#include "io/network_builder.hpp"
#include "io/range_fields.hpp"
#include "io/range_row_reader.hpp"
#include "isotherm/base/csv.hpp"
#include "isotherm/network/io/range_file.hpp"

namespace isotherm::network {
namespace {

double variance_field(TextReader& text) {
  const double variance = text.number("a variance");
  if (variance < 0.0) text.fail("expected a variance >= 0");
  return variance;
}

bool starts_with_letter(std::string_view token) {
  return std::isalpha(static_cast<unsigned char>(token.front())) != 0;
}

class PyfgReader {
 public:
  PyfgReader(TextReader& text, ReadReport& report) : text_(text), report_(report) {}

  RangeNetwork run() {
    while (detail::next_content_line(text_)) read_record();
    return builder_.finish(dimension_ == 0 ? 2 : dimension_);
  }

 private:
  void read_record() {
    const std::string tag(text_.word());
    if (tag == "VERTEX_SE2") {
      vertex(2, 1, false);
    } else if (tag == "VERTEX_SE3:QUAT") {
      vertex(3, 4, false);
    } else if (tag == "VERTEX_XY") {
      vertex(2, 0, true);
    } else if (tag == "VERTEX_XYZ") {
      vertex(3, 0, true);
    } else if (tag == "EDGE_RANGE") {
      range();
    } else if (!starts_with_letter(tag)) {
      text_.fail("expected a record tag such as EDGE_RANGE");
    } else {
      ++report_.skipped[tag];
      return;
    }
    text_.expect_line_end();
    ++report_.records[tag];
  }

  // Poses carry a time stamp; landmarks may.
  void vertex(int dimension, int rotation_numbers, bool landmark) {
    if (dimension_ != 0 && dimension_ != dimension) {
      text_.fail("record of another dimension than those before");
    }
    dimension_ = dimension;
    auto name = text_.word("a time stamp or a name");
    if (!starts_with_letter(name)) {
      double time = 0.0;
      if (!parse_number(name, time)) text_.fail("expected a time stamp or a name");
      name = text_.word("a name");
    }
    const Index node = builder_.node(name);
    const auto where = text_.location();
    std::array<double, 3> position{};
    for (int i = 0; i < dimension; ++i) position[i] = text_.number("a coordinate");
    for (int i = 0; i < rotation_numbers; ++i) text_.number("a rotation");
    if (!builder_.place(node, position)) {
      throw ParseError(where, std::string(name), "vertex already given");
    }
    if (landmark) builder_.add_landmark(node);
  }

  void range() {
    RangeMeasurement measurement;
    measurement.timestamp = text_.number("a time stamp");
    measurement.from = builder_.node(text_.word("the name of the first node"));
    measurement.to = builder_.node(text_.word("the name of the second node"));
    detail::require_other_end(text_, measurement);
    measurement.distance = detail::distance_field(text_);
    measurement.variance = variance_field(text_);
    measurement.line = text_.line_number();
    builder_.add_range(measurement);
  }

  TextReader& text_;
  ReadReport& report_;
  detail::NetworkBuilder builder_;
  int dimension_ = 0;
};

// range2 time range variance anchor_x anchor_y anchor_id signal
RangeNetwork read_librsf(TextReader& text, ReadReport& report) {
  detail::NetworkBuilder builder;
  while (detail::next_content_line(text)) {
    const std::string tag(text.word());
    if (tag != "range2") {
      if (!starts_with_letter(tag)) text.fail("expected a record tag such as range2");
      ++report.skipped[tag];
      continue;
    }
    RangeMeasurement measurement;
    measurement.timestamp = text.number("a time stamp");
    measurement.distance = detail::distance_field(text);
    measurement.variance = variance_field(text);
    const double x = text.number("the x of the anchor");
    const double y = text.number("the y of the anchor");
    std::string anchor = "L";
    anchor += text.word("the id of the anchor");
    while (!text.at_line_end()) text.number("a signal strength");
    measurement.from = builder.node(std::to_string(builder.range_count()));
    measurement.to = builder.node(anchor);
    builder.place(measurement.to, {x, y, 0.0});
    builder.add_landmark(measurement.to);
    measurement.line = text.line_number();
    builder.add_range(measurement);
    ++report.records[tag];
  }
  return builder.finish(2);
}

RangeNetwork read_csv(TextReader& text, ReadReport& report) {
  CsvReader csv(std::move(text));
  const auto from = csv.column("from", 0);
  const auto to = csv.column("to", 1);
  const auto range = csv.column("range", 2);
  const auto named_sigma = csv.find_column("sigma");
  detail::NetworkBuilder builder;
  while (csv.next_row()) {
    RangeMeasurement measurement;
    measurement.from = builder.node(csv.text(from, "the first node"));
    measurement.to = builder.node(csv.text(to, "the second node"));
    if (measurement.from == measurement.to) csv.fail(to, "expected another node than the first");
    measurement.distance = csv.number(range, "a distance");
    if (measurement.distance < 0.0) csv.fail(range, "expected a distance >= 0");
    if (named_sigma || (!csv.has_header() && csv.field_count() > 3)) {
      const auto column = named_sigma.value_or(3);
      const double sigma = csv.number(column, "a standard deviation");
      if (sigma < 0.0) csv.fail(column, "expected a standard deviation >= 0");
      measurement.variance = sigma * sigma;
    }
    measurement.line = csv.line_number();
    builder.add_range(measurement);
    ++report.records["range"];
  }
  report.lines = csv.line_number();
  return builder.finish(2);
}

// The first line that is neither empty nor a comment.
std::string_view first_content(std::string_view text) {
  while (!text.empty()) {
    const auto newline = text.find('\n');
    const auto line = text.substr(0, newline);
    const auto first = line.find_first_not_of(" \t\r");
    if (first != std::string_view::npos && line[first] != '#') return line.substr(first);
    if (newline == std::string_view::npos) break;
    text.remove_prefix(newline + 1);
  }
  return {};
}

RangeNetwork read_by_content(TextReader& text, const ReadOptions& options, ReadReport& report) {
  const auto start = first_content(text.peek());
  if (start.empty()) return {};
  if (start.find(',') != std::string_view::npos) {
    report.format = "ranges";
    return read_csv(text, report);
  }
  if (start.starts_with("range2") || start.starts_with("odom2diff")) {
    report.format = "librsf";
    return read_librsf(text, report);
  }
  if (starts_with_letter(start)) {
    report.format = "pyfg";
    return PyfgReader(text, report).run();
  }
  // The first row decides: here a row that differs is an error, with its line.
  return detail::read_range_rows(text, detect_range_rows(start.substr(0, start.find('\n'))),
                                 options, report);
}

}  // namespace

RangeFile read_ranges(TextReader& reader, const ReadOptions& options) {
  options.validate();
  RangeFile file;
  file.report.path = reader.path();
  file.network = read_by_content(reader, options, file.report);
  if (file.report.lines == 0) file.report.lines = reader.line_number();
  if (file.network.ranges.empty()) {
    throw ParseError({file.report.path, 0, 0}, "",
                     "no range; expected PyFG, rows of from,to,range, libRSF or distance "
                     "intervals");
  }
  return file;
}

RangeFile read_ranges(const std::string& path, const ReadOptions& options) {
  TextReader reader(path);
  return read_ranges(reader, options);
}

}  // namespace isotherm::network
