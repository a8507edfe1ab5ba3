#include "isotherm/slam/evaluate/ground_truth.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/evaluate/labels.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm_test/data.hpp"

namespace isotherm::slam {
namespace {

class GroundTruth : public testing::Test {
 protected:
  GroundTruth() { std::filesystem::create_directories(folder); }
  ~GroundTruth() override { std::filesystem::remove_all(folder); }

  std::string write(const std::string& name, const std::string& text) const {
    const auto path = folder / name;
    std::ofstream(path) << text;
    return path.string();
  }

  std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                 ("isotherm.ground_truth." + std::to_string(getpid()));
  PoseGraph<Pose2> graph{{5, 6, 7}, {}, {}, {}};
};

TEST_F(GroundTruth, PoseGraphsAreMatchedById) {
  const auto path = write("gt.g2o", "VERTEX_SE2 7 1 2 0.5\nVERTEX_SE2 5 3 4 0\n");
  const auto truth = read_ground_truth(graph, {.path = path, .timestamps = {}});
  ASSERT_EQ(truth.size(), 3u);
  EXPECT_EQ(truth[0]->translation(), Eigen::Vector2d(3, 4));
  EXPECT_FALSE(truth[1].has_value());
  EXPECT_EQ(truth[2]->angle(), 0.5);
}

TEST_F(GroundTruth, TrajectoriesAreInterpolatedAtTheTimesOfTheVertices) {
  // From 3.0 to -3.0 rad the shorter arc crosses pi.
  const auto path = write("gt.csv", "10,0,0,3.0\n12,4,2,-3.0\n20,4,2,-3.0\n");
  const auto stamps = write("stamps.txt", "9\n11\n15.5\n");
  const auto truth = read_ground_truth(graph, {.path = path, .timestamps = stamps});
  EXPECT_EQ(truth[0]->translation(), Eigen::Vector2d(0, 0)) << "before the first sample";
  EXPECT_LT((truth[1]->translation() - Eigen::Vector2d(2, 1)).norm(), 1e-12);
  EXPECT_NEAR(std::abs(truth[1]->angle()), std::numbers::pi, 1e-12);
  EXPECT_EQ(truth[2]->translation(), Eigen::Vector2d(4, 2));

  const auto gapped =
      read_ground_truth(graph, {.path = path, .timestamps = stamps, .max_gap = 1.5});
  EXPECT_TRUE(gapped[0].has_value());
  EXPECT_TRUE(gapped[1].has_value());
  EXPECT_FALSE(gapped[2].has_value()) << "3.5 s from the nearest sample";
}

TEST_F(GroundTruth, KittiCameraPosesAreSeenFromAbove) {
  // Forward 5 (camera z), 2 to the right (camera x), turned left by 0.3.
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  const auto row = [](double m00, double m02, double x, double m20, double m22, double z) {
    const auto number = [](double v) { return std::to_string(v) + " "; };
    return number(m00) + "0 " + number(m02) + number(x) + "0 1 0 0 " + number(m20) + "0 " +
           number(m22) + number(z) + "\n";
  };
  const auto path =
      write("gt.txt", row(1, 0, 0, 0, 1, 0) + row(c, -s, 2, s, c, 5) + row(1, 0, 0, 0, 1, 0));
  const auto truth = read_ground_truth(graph, {.path = path, .timestamps = {}});
  EXPECT_LT((truth[1]->translation() - Eigen::Vector2d(5, -2)).norm(), 1e-9);
  EXPECT_NEAR(truth[1]->angle(), 0.3, 1e-5);
}

TEST_F(GroundTruth, SaysWhatDoesNotFit) {
  const auto csv = write("gt.csv", "10,0,0,0\n12,4,2,0\n");
  EXPECT_THROW(read_ground_truth(graph, {.path = csv, .timestamps = {}}), InvalidArgument);
  const auto stamps = write("stamps.txt", "9\n11\n");
  EXPECT_THROW(read_ground_truth(graph, {.path = csv, .timestamps = stamps}), InvalidArgument);
  const auto space = write("gt.g2o", "VERTEX_SE3:QUAT 5 0 0 0 0 0 0 1\n");
  EXPECT_THROW(read_ground_truth(graph, {.path = space, .timestamps = {}}), InvalidArgument);
  EXPECT_THROW(read_ground_truth(graph, {.path = "nowhere", .timestamps = {}}), FileError);
}

TEST(RealGroundTruth, HalfOfTheLoopsOfBicoccaAreIncorrect) {
  ISOTHERM_REAL_DATA_OR_SKIP(folder, "paper/b25b");
  const auto file = read_pose_graph((folder / "B25b_0.000.g2o").string());
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  const auto truth =
      read_ground_truth(graph, {.path = (folder / "Bicocca_2009-02-25b-GT-extended.csv").string(),
                                .timestamps = (folder / "B25b_timestamps.txt").string()});
  const auto labels = label_candidates(graph, edge_roles(graph), truth);
  EXPECT_EQ(labels.size(), 446u);
  EXPECT_EQ(count(labels, Label::incorrect), 221);
}

}  // namespace
}  // namespace isotherm::slam
