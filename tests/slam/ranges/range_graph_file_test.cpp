#include "isotherm/slam/ranges/range_graph_file.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm::slam {
namespace {

using testing::HasSubstr;

RangeGraphFile read(const std::string& text) {
  TextReader reader("test", text);
  return read_range_graph(reader);
}

std::string message_of(const std::string& text) {
  try {
    read(text);
  } catch (const ParseError& error) {
    return error.what();
  }
  return {};
}

constexpr const char* kPlanar =
    "VERTEX_SE2 0.5 A0 1 2 0.3\nVERTEX_SE2 1.5 A1 2 2 0.3\nVERTEX_XY L0 5 6\n"
    "VERTEX_SE2:PRIOR 0.5 A0 1 2 0.3 1 0 0 1 0 0.25\n"
    "EDGE_SE2 1.5 A0 A1 1 0 0.1 0.01 0 0 0.04 0 0.25\n"
    "EDGE_RANGE 1.5 A1 L0 4.5 0.09\n";

TEST(RangeGraphFile, PlanarPyfg) {
  const auto file = read(kPlanar);
  const auto& graph = std::get<RangeGraph<Pose2>>(file.graph);
  EXPECT_EQ(graph.names, (std::vector<std::string>{"A0", "A1", "L0"}));
  EXPECT_EQ(graph.is_point, (std::vector<bool>{false, false, true}));
  EXPECT_EQ(graph.stamps[1], 1.5);
  ASSERT_EQ(graph.steps.size(), 1u);
  EXPECT_NEAR(graph.steps[0].information(1, 1), 25.0, 1e-12);
  EXPECT_NEAR(graph.steps[0].information(2, 2), 4.0, 1e-12);
  ASSERT_EQ(graph.priors.size(), 1u);
  EXPECT_NEAR(graph.priors[0].information(2, 2), 4.0, 1e-12);
  ASSERT_EQ(graph.ranges.size(), 1u);
  EXPECT_EQ(graph.ranges[0].distance, 4.5);
  EXPECT_EQ(graph.ranges[0].line, 6u);
}

TEST(RangeGraphFile, SpatialPyfg) {
  const auto file = read(
      "VERTEX_SE3:QUAT 0 A0 1 2 3 0 0 0 1\nVERTEX_XYZ L0 5 6 7\n"
      "EDGE_SE3:QUAT 1 A0 A1 1 0 0 0 0 0 1 "
      "1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4\nEDGE_RANGE 1 A1 L0 4.5 0.09\n");
  const auto& graph = std::get<RangeGraph<Pose3>>(file.graph);
  EXPECT_EQ(graph.node_count(), 3);
  EXPECT_NEAR(graph.steps[0].information(5, 5), 0.25, 1e-12);
  EXPECT_EQ(graph.placed, (std::vector<bool>{true, true, false}));
}

TEST(RangeGraphFile, Librsf) {
  const auto file = read(
      "range2 0.5 2.5 0.01 1 2 105 0\nodom2diff 0.5 0 0 0 0.1 1e-4 1e-4 1e-4\n"
      "odom2diff 1.0 0.1 0.3 0 0.05 1e-4 1e-4 1e-4\nrange2 1.0 2.6 0.01 1 2 105 0\n");
  const auto& graph = std::get<RangeGraph<Pose2>>(file.graph);
  EXPECT_EQ(graph.names, (std::vector<std::string>{"0", "1", "L105"}));
  ASSERT_EQ(graph.steps.size(), 1u);
  // Half a second at 0.2 m/s, turning to the left by 2 rad/s: the second wheel is the faster one.
  EXPECT_NEAR(graph.steps[0].T_from_to.angle(), 1.0, 1e-12);
  EXPECT_NEAR(graph.steps[0].T_from_to.log()[0], 0.1, 1e-12);
  EXPECT_EQ(graph.ranges[1].from, 1);
}

TEST(RangeGraphFile, ErrorsNameTheLine) {
  EXPECT_THAT(message_of("EDGE_SE2 1 A0 A0 1 0 0 1 0 0 1 0 1\n"), HasSubstr("test:1:"));
  EXPECT_THAT(message_of("EDGE_SE2 1 A0 A1 1 0 0 -1 0 0 1 0 1\n"), HasSubstr("positive definite"));
  EXPECT_THAT(message_of(std::string(kPlanar) + "VERTEX_XY L0 5 6\n"), HasSubstr("test:7:"));
  EXPECT_THAT(message_of(std::string(kPlanar) + "VERTEX_XYZ L1 5 6 7\n"),
              HasSubstr("another dimension"));
  EXPECT_THAT(message_of(std::string(kPlanar) + "EDGE_RANGE 1 A0 L0 -4 1\n"),
              HasSubstr("expected a distance >= 0"));
  EXPECT_THAT(message_of("odom2diff 1 0 0 0 0.1 1 1 1\nrange2 2 1 1 0 0 7 0\n"),
              HasSubstr("without odometry"));
  EXPECT_EQ(read("").report.lines, 0u);
}

}  // namespace
}  // namespace isotherm::slam
