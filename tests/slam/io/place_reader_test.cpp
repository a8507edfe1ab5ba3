#include <gtest/gtest.h>

#include "isotherm/slam/io/file_format.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm_test/data.hpp"
#include "isotherm_test/parse_error.hpp"

namespace isotherm::slam {
namespace {

PoseGraphFile parse_places(const std::string& text) {
  TextReader reader("f", text);
  return read_pose_graph(reader);
}

std::string place_error(const std::string& text) {
  return isotherm_test::parse_error_of([&] { parse_places(text); });
}

const std::string kStart = "odom2 0 0 0 0 0.01 0.01 0.04\n";

TEST(ReadPlaces, VelocitiesBecomeOdometry) {
  const auto file =
      parse_places(kStart + "odom2 0.5 2 0 0 0.01 0.04 0.25\nodom2 1 0 0 1 0.01 0.01 1\n");
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  ASSERT_EQ(graph.vertex_count(), 3);
  ASSERT_EQ(graph.constraint_count(), 2);
  EXPECT_EQ(graph.constraints[0].T_from_to.translation(), Eigen::Vector2d(1.0, 0.0));
  EXPECT_EQ(graph.constraints[0].information(0, 0), 1.0 / (0.25 * 0.01));
  EXPECT_EQ(graph.constraints[0].information(2, 2), 1.0 / (0.25 * 0.25));
  EXPECT_EQ(graph.poses[2].angle(), 0.5);
  EXPECT_EQ(graph.constraints[1].line, 3u);
}

TEST(ReadPlaces, RecognisedPlacesJoinTheNearestPoses) {
  const auto file = parse_places(kStart +
                                 "odom2 1 1 0 0 1 1 1\nodom2 2 1 0 0 1 1 1\nodom2 3 1 0 0 1 1 1\n"
                                 "loop 3.4 0.4 0.9\n");
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  const auto& loop = graph.constraints.back();
  EXPECT_EQ(loop.from, 3);
  EXPECT_EQ(loop.to, 0);
  EXPECT_EQ(loop.T_from_to.log().norm(), 0.0);
  EXPECT_EQ(loop.information(2, 2), 0.0) << "nothing is known about the heading";
  EXPECT_EQ(edge_roles(graph).candidates.size(), 1u);
}

TEST(ReadPlaces, LocatesErrors) {
  EXPECT_EQ(place_error("odom2 0 0 0 0 1 0 1\n"), "f:1:17: expected a variance > 0 (got '0')");
  EXPECT_EQ(place_error(kStart + "odom2 0 0 0 0 1 1 1\n"),
            "f:2:7: expected a later time stamp (got '0')");
  EXPECT_EQ(place_error(kStart + "loop 0 9 0.5\n"),
            "f:2:6: no odometry within a second of this time");
  EXPECT_EQ(place_error(kStart + "loop 0 0 1.5\n"),
            "f:2:10: expected a similarity in [0, 1] (got '1.5')");
  EXPECT_EQ(place_error(kStart + "range2 1\n"), "f:2:1: expected odom2 or loop (got 'range2')");
  EXPECT_EQ(place_error("loop 0 0 1\n"), "f: no odom2 line; expected velocities over time");
}

TEST(ReadPlaces, HasTheCountsItsSourceStates) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "placerec/tuc_corridor/Corridor_Input.txt.gz");
  const auto file = read_pose_graph(path.string());
  EXPECT_EQ(file.report.records.at("odom2"), 22692u);
  EXPECT_EQ(file.report.records.at("loop"), 10019u);
  EXPECT_EQ(std::get<PoseGraph<Pose2>>(file.graph).vertex_count(), 22692);
}

}  // namespace
}  // namespace isotherm::slam
