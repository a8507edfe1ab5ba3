// Several files as one graph.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/slam/graph/any_pose_graph.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm_test/parse_error.hpp"
#include "isotherm_test/temporary.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class SeveralFiles : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) {
    const auto path = (folder_.path() / name).string();
    isotherm_test::write_file(path, text);
    return path;
  }

  PoseGraphFile read(const std::vector<std::string>& paths, bool strict = false) {
    return read_pose_graphs(paths, {.strict = strict});
  }

  static std::string vertex(int id, double x) {
    return "VERTEX_SE2 " + std::to_string(id) + " " + std::to_string(x) + " 0 0\n";
  }
  static std::string edge(int from, int to, double x) {
    return "EDGE_SE2 " + std::to_string(from) + " " + std::to_string(to) + " " + std::to_string(x) +
           " 0 0 1 0 0 1 0 1\n";
  }

  TemporaryFolder folder_;
};

TEST_F(SeveralFiles, ShareVerticesAndCountARepeatOnce) {
  const auto a = file("a.g2o", vertex(1, 1) + vertex(0, 0.5) + edge(0, 1, 1) + edge(1, 11, 4));
  const auto b = file(
      "b.g2o", vertex(10, 5) + vertex(11, 6) + edge(10, 11, 1) + edge(1, 11, 4) + edge(1, 11, 4.5));
  const auto merged = read({b, a, b});
  const auto& graph = as<Pose2>(merged.graph);
  EXPECT_THAT(graph.ids, ElementsAre(0, 1, 10, 11));
  ASSERT_EQ(graph.constraint_count(), 4);
  EXPECT_EQ(merged.report.notes.at("repeated edge"), 4);
  EXPECT_THAT(merged.report.diagnostics.back().message, HasSubstr("repeats line 5 of " + b));
  EXPECT_EQ(merged.report.records.at("EDGE_SE2"), 8);
  EXPECT_EQ(graph.poses[3].translation().x(), 6.0) << "from its own line, not from an edge";
  const auto robots = robots_of(merged);
  ASSERT_EQ(robots.size(), 2u);
  EXPECT_EQ(robots[0].name, a) << "b occurs twice: whole paths tell apart";
  EXPECT_EQ(robots[0].vertices, 2u);
}

TEST_F(SeveralFiles, NeedNoRepairWhereTheyCompleteEachOther) {
  const auto a = file("a.g2o", vertex(10, 0) + vertex(11, 1) + edge(10, 11, 1) + edge(11, 0, 4));
  const auto b = file("b.g2o", vertex(0, 5) + vertex(1, 6) + edge(0, 1, 1));
  EXPECT_THAT(read({a, b}, true).report.repairs, IsEmpty());
  EXPECT_THAT(isotherm_test::parse_error_of([&] { read({a}, true); }),
              HasSubstr("vertex has no line of its own"));
}

TEST_F(SeveralFiles, AreRobotsUnlessOneGoesOnWhereAnotherEnds) {
  const auto a = file("a.g2o", vertex(0, 0) + vertex(1, 1) + edge(0, 1, 1) + edge(1, 10, 9));
  const auto b = file("b.g2o", vertex(10, 5) + vertex(11, 6) + edge(10, 11, 1));
  const auto apart = as<Pose2>(read({a, b}).graph);
  EXPECT_THAT(edge_roles(apart).odometry, ElementsAre(0, 2)) << "1 -> 10 is between robots";
  const auto c = file("c.g2o", vertex(2, 5) + vertex(3, 6) + edge(1, 2, 1) + edge(2, 3, 1));
  const auto joined = read({a, c});
  EXPECT_THAT(as<Pose2>(joined.graph).robots, IsEmpty());
  EXPECT_THAT(robots_of(joined), IsEmpty());
  EXPECT_EQ(edge_roles(as<Pose2>(joined.graph)).odometry.size(), 3u);
}

TEST_F(SeveralFiles, WithoutVertexLinesBelongToTheirOdometry) {
  const auto a = file("a.g2o", edge(1, 11, 3) + edge(0, 1, 1));
  const auto b = file("b.g2o", edge(10, 11, 1));
  EXPECT_THAT(as<Pose2>(read({a, b}).graph).robots, ElementsAre(0, 0, 1, 1));
}

TEST_F(SeveralFiles, LettersSayWhoseAPoseIs) {
  const std::string a0 = "6989586621679009792";
  const std::string a1 = "6989586621679009793";
  const std::string b0 = "7061644215716937728";
  const std::string tail = " 1 0 0 1 0 0 1 0 1\n";
  const auto a = file("x.g2o", "EDGE_SE2 " + a0 + " " + a1 + tail);
  const auto b = file("y.g2o", "EDGE_SE2 " + a1 + " " + b0 + tail);
  const auto robots = robots_of(read({a, b}));
  ASSERT_EQ(robots.size(), 2u);
  EXPECT_EQ(robots[0].name, "a");
  EXPECT_EQ(robots[1].name, "b");
  EXPECT_EQ(vertex_name(6989586621679009988u), "a196");
  EXPECT_EQ(vertex_name(196), "196");
  EXPECT_EQ(vertex_name(std::uint64_t{200} << 56), std::to_string(std::uint64_t{200} << 56));
}

TEST_F(SeveralFiles, SayWhatDoesNotFit) {
  const auto plane = file("plane.g2o", vertex(0, 0) + vertex(1, 1) + edge(0, 1, 1));
  const auto moved = file("moved.g2o", vertex(0, 3));
  const auto space = file("space.g2o", "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n");
  const auto track = file("track.tum", "1 0 0 0 0 0 0 1\n");
  const auto error = [&](const std::vector<std::string>& paths) {
    return isotherm_test::parse_error_of([&] { read(paths); });
  };
  EXPECT_THAT(error({plane, space}), HasSubstr("space.g2o: has poses in space, unlike"));
  EXPECT_THAT(error({plane, track}), HasSubstr("this one is in format tum"));
  EXPECT_THAT(error({plane, file("bad.g2o", "EDGE_SE2 0 1 x\n")}), HasSubstr("bad.g2o:1:14"));
  EXPECT_THAT(error({plane, file("twice.g2o", vertex(5, 0) + vertex(5, 0))}),
              HasSubstr("twice.g2o:2: vertex already given at line 1"));
  const auto report = read({plane, moved}).report;
  EXPECT_EQ(report.notes.at("vertex with two poses"), 1);
  EXPECT_EQ(report.diagnostics.front().where.path, moved);
}

}  // namespace
}  // namespace isotherm::slam
