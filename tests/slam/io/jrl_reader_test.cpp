#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/pose_graph_stream.hpp"

namespace isotherm::slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr VertexId kA = VertexId{'a'} << 56;
constexpr VertexId kB = VertexId{'b'} << 56;

std::string between(VertexId from, VertexId to, const std::string& x = "1") {
  return R"({"type": "BetweenFactorPose2", "key1": )" + std::to_string(from) + R"(, "key2": )" +
         std::to_string(to) + R"(, "measurement": {"type": "Pose2", "x": )" + x +
         R"(, "y": 0, "theta": 0.5}, "covariance": [0.25, 0.1, 0, 0.1, 0.5, 0, 0, 0, 0.1]})";
}

// An entry as nlohmann's library writes it: names in the order of the alphabet.
std::string entry(int stamp, const std::vector<std::string>& measurements) {
  std::string text = "{\"measurements\": [";
  for (const auto& m : measurements) text += (m == measurements.front() ? "" : ",\n") + m;
  return text + "], \"stamp\": " + std::to_string(stamp) + "}";
}

// Two robots. b's log begins before a's; a's second entry holds two loops, the second one false.
std::string log(const std::string& more) {
  return "{\"name\": \"two robots\", \"robots\": [\"a\", \"b\"],\n" + more +
         "\"measurements\": {\"a\": [" + entry(20, {between(kA, kA + 1)}) + ",\n" +
         entry(30, {between(kA + 1, kA + 2), between(kA, kB, "3"), between(kA + 2, kA, "4")}) +
         "],\n\"b\": [" + entry(10, {between(kB, kB + 1)}) + "]}}\n";
}

const std::string kLabels =
    "\"potential_outlier_factors\": {\"a\": [[1, 1], [1, 2]]},\n"
    "\"outlier_factors\": {\"a\": [[1, 2]]},\n";

PoseGraphFile read_jrl(const std::string& text, const ReadOptions& options = {}) {
  TextReader reader("a.jrl", text);
  return read_pose_graph(reader, options);
}

TEST(Jrl, HasTheMeasurementsOfAllRobotsInOrderOfTime) {
  const auto file = read_jrl(log(kLabels));
  EXPECT_EQ(file.report.format, "jrl");
  EXPECT_EQ(file.report.records.at("BetweenFactorPose2"), 5U);
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  EXPECT_THAT(graph.ids, ElementsAre(kA, kA + 1, kA + 2, kB, kB + 1));
  ASSERT_EQ(graph.constraints.size(), 5U);
  EXPECT_EQ(graph.ids[graph.constraints[0].from], kB);  // first in time
  EXPECT_EQ(graph.ids[graph.constraints[1].from], kA);
  EXPECT_EQ(graph.constraints[0].link, LinkKind::odometry);
  EXPECT_EQ(graph.constraints[3].link, LinkKind::loop);
  EXPECT_EQ(graph.constraints[4].T_from_to.translation().x(), 4.0);
  EXPECT_EQ(file.correct, (std::vector<bool>{true, true, true, true, false}));
  EXPECT_EQ(edge_roles(graph).candidates, (std::vector<Index>{3, 4}));
  Eigen::Matrix3d covariance;
  covariance << 0.25, 0.1, 0, 0.1, 0.5, 0, 0, 0, 0.1;
  EXPECT_LT((graph.constraints[0].information * covariance - Eigen::Matrix3d::Identity()).norm(),
            1e-12);
  const auto robots = robots_of(file);
  ASSERT_EQ(robots.size(), 2U);
  EXPECT_EQ(robots[1].name, "b");
}

TEST(Jrl, TellsLoopsByTheirEndsWhereItNamesNone) {
  const auto file = read_jrl(log(""));
  EXPECT_TRUE(file.correct.empty());
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  EXPECT_EQ(graph.constraints[4].link, LinkKind::unknown);
  EXPECT_EQ(edge_roles(graph).candidates, (std::vector<Index>{3, 4}));
}

// Keys stand in the order of their digits, landmarks are among them, and b knows a pose of a's.
TEST(Jrl, HasInitialAndTruePoses) {
  const auto pose = [](VertexId id, const std::string& x) {
    return "\"" + std::to_string(id) + R"(": {"type": "Pose2", "x": )" + x +
           R"(, "y": 0, "theta": 0})";
  };
  const auto file = read_jrl(
      log("\"initialization\": {\"b\": {" + pose(kB + 1, "7") + "," + pose(kB, "6") + "," +
          pose(kA, "5") + R"(}, "a": {"1000000001": {"type": "Point2", "x": 1, "y": 1},)" +
          pose(kA, "9") + "," + pose(kA + 2, "8") + "," + pose(kA + 1, "2") +
          "}},\n\"groundtruth\": {\"a\": {" + pose(kA + 1, "3") + "," + pose(kA, "4") + "}},\n"),
      {.strict = true});
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  ASSERT_EQ(graph.poses.size(), 5U);
  EXPECT_EQ(graph.poses[0].translation().x(), 5.0);
  EXPECT_EQ(graph.poses[4].translation().x(), 7.0);
  ASSERT_TRUE(file.truth);
  const auto& truth = std::get<PoseGraph<Pose2>>(*file.truth);
  EXPECT_THAT(truth.ids, ElementsAre(kA, kA + 1));
  EXPECT_EQ(truth.poses[1].translation().x(), 3.0);
}

TEST(Jrl, HasRotationFirstInCovariancesOfSpace) {
  std::string covariance;
  for (int k = 0; k < 36; ++k) {
    covariance += (k > 0 ? ", " : "") + std::string(k % 7 != 0 ? "0" : k < 18 ? "0.25" : "2");
  }
  const auto file =
      read_jrl(R"({"measurements": {"a": [{"stamp": 0, "measurements": [)"
               R"({"type": "BetweenFactorPose3", "key1": 0, "key2": 1, "measurement": )"
               R"({"translation": [1, 2, 3], "rotation": [0.8, 0, 0, 0.6]}, )"
               R"("covariance": [)" +
               covariance + "]}]}]}}");
  const auto& edge = std::get<PoseGraph<Pose3>>(file.graph).constraints.front();
  EXPECT_EQ(edge.information(0, 0), 0.5);
  EXPECT_EQ(edge.information(5, 5), 4.0);
  EXPECT_EQ(edge.T_from_to.rotation().z(), 0.6);
  EXPECT_EQ(edge.T_from_to.translation().y(), 2.0);
}

TEST(Jrl, IsReplayedAsAStream) {
  const std::string text = log(kLabels);
  std::istringstream in(text);
  PoseGraphStream stream(in, "a.jrl");
  const auto whole = read_jrl(text);
  const auto& graph = std::get<PoseGraph<Pose2>>(whole.graph);
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    const auto entry = stream.next();
    ASSERT_TRUE(entry);
    const auto& edge = std::get<StreamEdge<Pose2>>(*entry);
    EXPECT_EQ(edge.from, graph.ids[graph.constraints[k].from]);
    EXPECT_EQ(edge.measured.link, graph.constraints[k].link);
    EXPECT_EQ(edge.correct, whole.correct[k]);
  }
  EXPECT_FALSE(stream.next());
  EXPECT_FALSE(stream.next());
}

TEST(Jrl, NotesWhatItDoesNotUse) {
  const std::string range = R"({"type": "RangeFactorPose2", "key1": 0, "key2": 1, )"
                            R"("measurement": 2.5, "covariance": [1]})";
  const auto file =
      read_jrl("{\"measurements\": {\"a\": [" + entry(1, {between(0, 1), range, range}) + "]}}");
  EXPECT_EQ(file.report.skipped.at("RangeFactorPose2"), 2U);
  EXPECT_EQ(file.report.diagnostics.size(), 1U);
}

TEST(Jrl, SaysWhatIsWrongAndWhere) {
  const auto message = [](const std::string& text) {
    try {
      read_jrl(text);
    } catch (const ParseError& error) {
      return std::string(error.what());
    }
    return std::string("read without error");
  };
  EXPECT_THAT(message("{}"), HasSubstr("no measurements"));
  EXPECT_THAT(message(R"({"measurements": {}})"), HasSubstr("no BetweenFactorPose2"));
  EXPECT_THAT(message(log("\"outlier_factors\": {\"a\": [[1]]},\n")),
              HasSubstr("a.jrl:2:28: expected an entry and a measurement"));
  EXPECT_THAT(message(log("\"outlier_factors\": [[1, 2]],\n")),
              HasSubstr("a.jrl:2:20: expected factors of each robot"));
  EXPECT_THAT(message(log("\"groundtruth\": {\"a\": {\"x1\": {}}},\n")),
              HasSubstr("expected a key"));
  EXPECT_THAT(message(log("") + "{}"), HasSubstr("expected the end of the file"));
  EXPECT_THAT(message(R"({"measurements": {"a": [{"measurements": [{"type": )"
                      R"("BetweenFactorPose2", "key1": 0, "key2": 1}]}]}})"),
              HasSubstr("expected a measurement with a pose"));
}

}  // namespace
}  // namespace isotherm::slam
