#include "io/range_row_reader.hpp"

#include <cmath>
#include <string>

#include "io/network_builder.hpp"
#include "io/range_fields.hpp"

namespace isotherm::network::detail {
namespace {

constexpr double kMetresPerMicrosecond = 299.792458;  // light

// What reading a row needs.
struct Rows {
  TextReader& text;
  NetworkBuilder& builder;
  const ReadOptions& options;
  ReadReport& report;
};

std::string node_field(TextReader& text, std::string_view what) {
  return std::to_string(text.unsigned_integer(what));
}

// A whole number, perhaps written as 2.0e+000.
std::string whole_field(TextReader& text, std::string_view what) {
  const double value = text.number(what);
  if (value < 0.0 || value > 9e15 || value != std::floor(value)) {
    text.fail("expected " + std::string(what) + ", a whole number");
  }
  return std::to_string(static_cast<std::uint64_t>(value));
}

// i j lower upper [names ...]
void read_interval(Rows& rows) {
  auto& text = rows.text;
  RangeMeasurement measurement;
  measurement.from = rows.builder.node(node_field(text, "the first node"));
  measurement.to = rows.builder.node(node_field(text, "the second node"));
  require_other_end(text, measurement);
  const double lower = distance_field(text);
  const double upper = distance_field(text);
  if (upper < lower) text.fail("expected an upper bound not below the lower one");
  measurement.distance = 0.5 * lower + 0.5 * upper;
  measurement.variance = (upper - lower) * (upper - lower) / 12.0;
  measurement.line = text.line_number();
  rows.builder.add_range(measurement);
}

// time tag beacon range
void read_beacon(Rows& rows) {
  auto& text = rows.text;
  RangeMeasurement measurement;
  measurement.timestamp = text.number("a time stamp");
  whole_field(text, "the id of the tag");
  std::string beacon("L");
  beacon += whole_field(text, "the id of the beacon");
  measurement.distance = distance_field(text);
  text.expect_line_end();
  measurement.from = rows.builder.node(std::to_string(rows.builder.range_count()));
  measurement.to = rows.builder.node(beacon);
  rows.builder.add_landmark(measurement.to);
  measurement.line = text.line_number();
  rows.builder.add_range(measurement);
}

// microseconds node node, and diagnostics of the radio
void read_flight_time(Rows& rows) {
  auto& text = rows.text;
  const double microseconds = text.number("a time of flight");
  const auto where = text.location();
  RangeMeasurement measurement;
  measurement.distance = kMetresPerMicrosecond * microseconds;
  measurement.from = rows.builder.node(node_field(text, "the first node"));
  measurement.to = rows.builder.node(node_field(text, "the second node"));
  require_other_end(text, measurement);
  while (!text.at_line_end()) text.number("a radio diagnostic");
  measurement.line = text.line_number();
  if (microseconds >= 0.0) {
    rows.builder.add_range(measurement);
  } else {
    rows.report.add_repair(rows.options, {"negative time of flight", where, "",
                                          "time of flight is negative; the row is left out"});
  }
}

struct RowFormat {
  const char* format;
  const char* record;
  int dimension;
  void (*read)(Rows&);
};

RowFormat row_format(RangeRows kind) {
  switch (kind) {
    case RangeRows::beacons:
      return {"beacons", "beacon range", 2, read_beacon};
    case RangeRows::flight_times:
      return {"flight-times", "flight time", 2, read_flight_time};
    case RangeRows::intervals:
    case RangeRows::none:
      break;
  }
  return {"intervals", "interval", 3, read_interval};
}

}  // namespace

RangeNetwork read_range_rows(TextReader& text, RangeRows kind, const ReadOptions& options,
                             ReadReport& report) {
  const auto format = row_format(kind);
  report.format = format.format;
  NetworkBuilder builder;
  Rows rows{text, builder, options, report};
  while (next_content_line(text)) {
    format.read(rows);
    ++report.records[format.record];
  }
  return builder.finish(format.dimension);
}

}  // namespace isotherm::network::detail
