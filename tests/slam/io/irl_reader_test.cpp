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

using testing::HasSubstr;

const std::string kHeader = "A small one\n2026-01-01\n2\nnonlinear\nfour poses\n";
const std::string kPlanar = kHeader +
                            "PRIOR 1 0 0 0 0 0 0.01 0 0 0 0.01 0 0 0 0.01\n"
                            "ODOMETRY 1 0 0 1 1 0 0.5 0.25 0 0 0 0.5 0 0 0 0.1\n"
                            "ODOMETRY 1 0 1 2 1 0 0.5 0.25 0 0 0 0.5 0 0 0 0.1\n"
                            "LOOP 2 0 2 0 -1 2 3 0.25 0.1 0 0.1 0.5 0 0 0 0.1 NULL\n"
                            "LOOP 2 1 1 0 -1 2 3 0.25 0 0 0 0.5 0 0 0 0.1 NULL\n"
                            "LOOP 2 1 0 2 NULL 7 2 3 0.25 0 0 0 0.5 0 0 0 0.1\n";

PoseGraphFile read(const std::string& text) {
  TextReader reader("a.irl", text);
  return read_pose_graph(reader);
}

TEST(Irl, HasMeasurementsWithCovariancesAndWhetherTheyAreTrue) {
  const auto file = read(kPlanar);
  EXPECT_EQ(file.report.format, "irl");
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  EXPECT_EQ(graph.ids, (std::vector<VertexId>{0, 1, 2}));
  ASSERT_EQ(graph.constraints.size(), 5U);
  EXPECT_EQ(graph.constraints[0].link, LinkKind::odometry);
  EXPECT_EQ(graph.constraints[0].information(0, 0), 4.0);
  const auto& loop = graph.constraints[2];
  EXPECT_EQ(loop.link, LinkKind::loop);
  EXPECT_EQ(loop.T_from_to.angle(), 3.0);
  Eigen::Matrix3d covariance;
  covariance << 0.25, 0.1, 0, 0.1, 0.5, 0, 0, 0, 0.1;
  EXPECT_LT((loop.information * covariance - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_EQ(graph.constraints[4].T_from_to.translation().x(), 7.0);
  EXPECT_EQ(file.correct, (std::vector<bool>{true, true, true, false, true}));
}

TEST(Irl, HasRotationFirstInCovariancesOfSpace) {
  std::string line = "ODOMETRY 1 0 0 1 1 2 3 0.1 0.2 0.3";
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      line += row == column ? (row < 3 ? " 0.25" : " 2") : " 0";
    }
  }
  const auto file = read("A\nB\n3\nnonlinear\nC\n" + line + "\n");
  const auto& edge = std::get<PoseGraph<Pose3>>(file.graph).constraints.front();
  EXPECT_EQ(edge.information(0, 0), 0.5);
  EXPECT_EQ(edge.information(5, 5), 4.0);
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  EXPECT_LT((edge.T_from_to.rotation_matrix() - R).norm(), 1e-12);
}

TEST(Irl, IsReadTheSameAsAStream) {
  std::istringstream in(kPlanar);
  PoseGraphStream stream(in, "a.irl");
  const auto whole = read(kPlanar);
  const auto& graph = std::get<PoseGraph<Pose2>>(whole.graph);
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    const auto entry = stream.next();
    ASSERT_TRUE(entry);
    const auto& edge = std::get<StreamEdge<Pose2>>(*entry);
    EXPECT_EQ(edge.from, graph.ids[graph.constraints[k].from]);
    EXPECT_EQ(edge.measured.information, graph.constraints[k].information);
    EXPECT_EQ(edge.correct, whole.correct[k]);
    EXPECT_EQ(stream.line_number(), graph.constraints[k].line);
  }
  EXPECT_FALSE(stream.next());
}

TEST(Irl, SaysWhatIsWrongAndWhere) {
  const auto message = [](const std::string& entry, const std::string& header = kHeader) {
    try {
      read(header + entry + "\n");
    } catch (const ParseError& error) {
      return std::string(error.what());
    }
    return std::string("read without error");
  };
  const std::string one = " 1 0 0 1 0 0 0 1 0 0 0 1";
  EXPECT_THAT(message("LOOP 2 0 0 1" + one + one), HasSubstr("several measured modes"));
  EXPECT_THAT(message("LOOP 2 0 0 1 NULL NULL"), HasSubstr("without a measurement"));
  EXPECT_THAT(message("ODOMETRY 2 0 0 1" + one + " NULL"), HasSubstr("one mode"));
  EXPECT_THAT(message("LEAP 1 0 0 1" + one), HasSubstr("a.irl:6:"));
  EXPECT_THAT(message("ODOMETRY 1 0 0 1 1 0"), HasSubstr("a.irl:6:"));
  EXPECT_THAT(message(""), HasSubstr("no odometry and no loop"));
  EXPECT_THAT(message("ODOMETRY 1 0 0 1 1 2 1 0 0 1", "A\nB\n2\nlinear\nC\n"),
              HasSubstr("linear problem"));
}

TEST(PoseGraphStream, TakesRecordsAsTheyCome) {
  std::istringstream in(
      "PARAMS 1\n# note\nFIX 3\nVERTEX_SE3:QUAT 3 1 2 3 0 0 0 1\n\n"
      "EDGE_SE3:QUAT 3 4 1 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n");
  PoseGraphStream stream(in, "a.g2o");
  EXPECT_EQ(std::get<StreamFixed>(*stream.next()).id, 3U);
  EXPECT_EQ(std::get<StreamVertex<Pose3>>(*stream.next()).pose.translation().z(), 3.0);
  EXPECT_EQ(std::get<StreamEdge<Pose3>>(*stream.next()).to, 4U);
  EXPECT_EQ(stream.line_number(), 6U);
  EXPECT_FALSE(stream.next());
}

}  // namespace
}  // namespace isotherm::slam
