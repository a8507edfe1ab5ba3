#include "isotherm/network/io/range_file.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm_test/data.hpp"
#include "isotherm_test/parse_error.hpp"
#include "isotherm_test/temporary.hpp"

namespace isotherm::network {
namespace {

using testing::ElementsAre;
using testing::Pair;

RangeFile parse(const std::string& text) {
  TextReader reader("f", text);
  return read_ranges(reader);
}

std::string error_of(const std::string& text) {
  return isotherm_test::parse_error_of([&] { parse(text); });
}

TEST(ReadRanges, Pyfg) {
  const auto file = parse(
      "VERTEX_SE2 10.5 A0 1 2 0.5\n"
      "VERTEX_XY L0 4 6\n"
      "EDGE_SE2 10.5 A0 A1 1 0 0 0.01 0 0 0.01 0 0.01\n"
      "EDGE_RANGE 10.5 A0 L0 5.1 0.04\n"
      "EDGE_RANGE 11.5 A1 L0 4.2 0.04\n");
  const auto& network = file.network;
  EXPECT_EQ(network.dimension, 2);
  EXPECT_THAT(network.names, ElementsAre("A0", "L0", "A1"));
  EXPECT_THAT(network.landmarks, ElementsAre(1));
  EXPECT_EQ(network.positions.col(1), Eigen::Vector2d(4, 6));
  EXPECT_TRUE(std::isnan(network.positions(0, 2)));
  ASSERT_EQ(network.ranges.size(), 2u);
  EXPECT_EQ(network.ranges[1].from, 2);
  EXPECT_EQ(network.ranges[1].to, 1);
  EXPECT_EQ(network.ranges[1].distance, 4.2);
  EXPECT_EQ(network.ranges[1].variance, 0.04);
  EXPECT_EQ(network.ranges[1].timestamp, 11.5);
  EXPECT_EQ(network.ranges[1].line, 5u);
  EXPECT_THAT(file.report.skipped, ElementsAre(Pair("EDGE_SE2", 1)));
}

TEST(ReadRanges, CommaSeparatedAndBack) {
  const auto file = parse("from,to,range,sigma\na,b,1.5,0.1\nb,c,2,0.2\n");
  EXPECT_THAT(file.network.names, ElementsAre("a", "b", "c"));
  EXPECT_NEAR(file.network.ranges[1].variance, 0.04, 1e-15);
  const isotherm_test::TemporaryFolder folder;
  write_range_csv(folder / "r.csv", file.network);
  const auto back = read_ranges(folder / "r.csv");
  EXPECT_EQ(back.network.names, file.network.names);
  EXPECT_EQ(back.network.ranges[0].distance, 1.5);
  EXPECT_NEAR(back.network.ranges[0].variance, file.network.ranges[0].variance, 1e-16);
}

TEST(ReadRanges, LibrsfAndIntervals) {
  const auto librsf = parse("odom2diff 0.1 1 1 0\nrange2 0.1 2.9 0.01 -0.02 -0.01 105 0 \n");
  EXPECT_THAT(librsf.network.names, ElementsAre("0", "L105"));
  EXPECT_EQ(librsf.network.positions.col(1), Eigen::Vector2d(-0.02, -0.01));
  const auto intervals = parse("   5    6       0.25       0.25 \n 6 9 1 2\n");
  EXPECT_EQ(intervals.network.dimension, 3);
  EXPECT_EQ(intervals.network.ranges[0].variance, 0.0);
  EXPECT_EQ(intervals.network.ranges[1].distance, 1.5);
}

TEST(ReadRanges, BeaconsHeardByAMovingTag) {
  const auto file =
      parse("  3.858e+003\t 2.0e+000 5.0e+000 6.5e+001\t\n  3.859e+003 2.0e+000 6.0e+000 35.5\n");
  EXPECT_EQ(file.report.format, "beacons");
  EXPECT_THAT(file.network.names, ElementsAre("0", "L5", "1", "L6"));
  EXPECT_THAT(file.network.landmarks, ElementsAre(1, 3));
  EXPECT_EQ(file.network.ranges[0].timestamp, 3858.0);
  EXPECT_EQ(file.network.ranges[1].distance, 35.5);
}

TEST(ReadRanges, TimesOfFlight) {
  std::string diagnostics;
  for (int k = 0; k < 18; ++k) diagnostics += " -1.5";
  const auto file = parse("0.5 12 8" + diagnostics + "\n0.25 8 14" + diagnostics + "\n");
  EXPECT_EQ(file.report.format, "flight-times");
  EXPECT_THAT(file.network.names, ElementsAre("12", "8", "14"));
  EXPECT_EQ(file.network.ranges[0].distance, 0.5 * 299.792458);
  EXPECT_EQ(file.network.ranges[1].from, 1);
}

TEST(ReadRanges, LeavesOutTimesOfFlightBelowZero) {
  std::string diagnostics;
  for (int k = 0; k < 18; ++k) diagnostics += " 0";
  const std::string text = "0.5 12 8" + diagnostics + "\n-289 8 14" + diagnostics + "\n";
  const auto file = parse(text);
  EXPECT_EQ(file.network.ranges.size(), 1u);
  EXPECT_EQ(file.report.records.at("flight time"), 2u);
  EXPECT_EQ(file.report.repairs.at("negative time of flight"), 1u);
  TextReader reader("f", text);
  EXPECT_THROW(read_ranges(reader, {.strict = true}), ParseError);
}

TEST(ReadRanges, LocatesErrors) {
  const std::string expected =
      "; expected PyFG, rows of from,to,range, libRSF or distance intervals";
  EXPECT_EQ(error_of(""), "f: no range" + expected);
  EXPECT_EQ(error_of("VERTEX_XY L0 1 2\n"), "f: no range" + expected);
  EXPECT_EQ(error_of("EDGE_RANGE 1 A0 L0 -1 1\n"), "f:1:20: expected a distance >= 0 (got '-1')");
  EXPECT_EQ(error_of("EDGE_RANGE 1 A0 A0 1 1\n"),
            "f:1:17: expected another node than the first (got 'A0')");
  EXPECT_EQ(error_of("from,to,range\na,b,1\nb,b,1\n"),
            "f:3:3: expected another node than the first (got 'b')");
  EXPECT_EQ(error_of("1 1 3 4\n"), "f:1:3: expected another node than the first (got '1')");
  EXPECT_EQ(error_of("EDGE_RANGE 1 A0 L0 1\n"),
            "f:1:21: expected a variance, found the end of the line");
  EXPECT_EQ(error_of("VERTEX_XY L0 1 2\nVERTEX_XYZ L1 1 2 3\n"),
            "f:2:1: record of another dimension than those before (got 'VERTEX_XYZ')");
  EXPECT_EQ(error_of("VERTEX_XY L0 1 2\nVERTEX_XY L0 1 2\n"),
            "f:2:11: vertex already given (got 'L0')");
  EXPECT_EQ(error_of("1 2 3 2\n"),
            "f:1:7: expected an upper bound not below the lower one (got '2')");
  EXPECT_EQ(error_of("10.5 1 2 3.5\n10.5 1 2.5 3.5\n"),
            "f:2:8: expected the id of the beacon, a whole number (got '2.5')");
  EXPECT_EQ(error_of("10.5 1 2 3.5\n10.5 1 2 -3\n"), "f:2:10: expected a distance >= 0 (got '-3')");
}

struct RealFile {
  const char* name;
  const char* format;
  Index nodes;
  std::size_t ranges;

  friend void PrintTo(const RealFile& file, std::ostream* out) { *out << file.name; }
};

class RealRanges : public testing::TestWithParam<RealFile> {};

TEST_P(RealRanges, HaveTheCountsTheirSourcesState) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, GetParam().name);
  const auto file = read_ranges(path.string());
  EXPECT_EQ(file.report.format, GetParam().format);
  EXPECT_EQ(file.network.node_count(), GetParam().nodes);
  EXPECT_EQ(file.network.ranges.size(), GetParam().ranges);
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealRanges,
    testing::Values(RealFile{"snl/plaza1/plaza1.pyfg", "pyfg", 9662, 3326},
                    RealFile{"snl/single_drone/single_drone.pyfg", "pyfg", 1755, 1754},
                    RealFile{"snl/plaza1/Plaza1_TD.txt", "beacons", 3533, 3529},
                    RealFile{"snl/acshi_uwb8/dataset4.txt.gz", "flight-times", 8, 28660},
                    RealFile{"snl/labyrinth_uwb/Indoor_UWB_Input.txt", "librsf", 237, 233},
                    RealFile{"snl/mdjeep_sensorSet1/sensor056.nmr", "intervals", 56, 191},
                    RealFile{"snl/mdjeep_sensorSet1/sensor073.nmr", "intervals", 73, 625},
                    RealFile{"snl/mdjeep_sensorSet1/sensor103.nmr", "intervals", 103, 1217},
                    RealFile{"snl/mdjeep_sensorSet1/sensor148.nmr", "intervals", 148, 2397},
                    RealFile{"geomgraph/protein_contacts/1crn.nmr", "intervals", 138, 846},
                    RealFile{"geomgraph/protein_contacts/1ptq.nmr", "intervals", 150, 829}));

}  // namespace
}  // namespace isotherm::network
