#include "isotherm/slam/io/trajectory_file.hpp"

#include <cmath>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm_test/data.hpp"
#include "isotherm_test/parse_error.hpp"
#include "isotherm_test/temporary.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::read_file;
using isotherm_test::TemporaryFolder;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TrajectoryFile parse_trajectory(const std::string& text, bool strict = false) {
  TextReader reader("f", text);
  return read_trajectory(reader, {.strict = strict});
}

Trajectory<Pose3> spatial_trajectory(const std::string& text) {
  return std::get<Trajectory<Pose3>>(parse_trajectory(text).trajectory);
}

std::string trajectory_error(const std::string& text) {
  return isotherm_test::parse_error_of([&] { parse_trajectory(text); });
}

TEST(ReadTrajectory, Tum) {
  const auto file =
      parse_trajectory("# time x y z qx qy qz qw\n1.5 1 2 3 0 0 0.6 0.8\n2.5 4 5 6 0 0 0 1\n");
  EXPECT_EQ(file.report.format, "tum");
  const auto& trajectory = std::get<Trajectory<Pose3>>(file.trajectory);
  EXPECT_THAT(trajectory.timestamps, ElementsAre(1.5, 2.5));
  EXPECT_EQ(trajectory.poses[0].translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(trajectory.poses[0].rotation().z(), 0.6);
  EXPECT_EQ(trajectory.poses[0].rotation().w(), 0.8);
}

TEST(ReadTrajectory, KittiWithAndWithoutStamps) {
  const std::string quarter_turn = "0 -1 0 1 1 0 0 2 0 0 1 3";
  const auto plain = spatial_trajectory(quarter_turn + "\n" + quarter_turn);
  EXPECT_THAT(plain.timestamps, IsEmpty());
  ASSERT_EQ(plain.poses.size(), 2u);
  EXPECT_EQ(plain.poses[1].translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(plain.poses[1].rotation().z(), std::sqrt(0.5), 1e-15);
  const auto stamped = spatial_trajectory("0.1 " + quarter_turn + "\n0.2 " + quarter_turn + "\n");
  EXPECT_THAT(stamped.timestamps, ElementsAre(0.1, 0.2));
  EXPECT_EQ(stamped.poses[0].translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(ReadTrajectory, Euroc) {
  const auto trajectory = spatial_trajectory(
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x []\n"
      "1403636580838555648,4.6,-1.7,0.7,0.8,0.6,0,0,0.1,0.2,0.3\r\n");
  EXPECT_THAT(trajectory.timestamps, ElementsAre(1403636580838555648.0 / 1e9));
  EXPECT_EQ(trajectory.poses[0].rotation().w(), 0.8);
  EXPECT_EQ(trajectory.poses[0].rotation().x(), 0.6);
}

TEST(ReadTrajectory, PlanarRowsWithBlanksOrCommasAndNames) {
  for (const char* text : {"10 1 2 0.5\n11 3 4 0.25\n", "10, 1, 2, 0.5\n11,3,4,0.25",
                           "time,x,y,theta\n10,1,2,0.5\n11,3,4,0.25\n"}) {
    const auto file = parse_trajectory(text);
    const auto& trajectory = std::get<Trajectory<Pose2>>(file.trajectory);
    EXPECT_THAT(trajectory.timestamps, ElementsAre(10, 11)) << text;
    EXPECT_EQ(trajectory.poses[1].translation(), Eigen::Vector2d(3, 4));
    EXPECT_EQ(trajectory.poses[1].angle(), 0.25);
  }
}

TEST(ReadTrajectory, PositionsTakeTheirHeadingsByTime) {
  const auto file = parse_trajectory("point2 0 1 2 0 0 0 0\npoint2 1 3 4 0 0 0 0\nangle 1 0.5 0\n");
  EXPECT_EQ(file.report.format, "points");
  const auto& trajectory = std::get<Trajectory<Pose2>>(file.trajectory);
  EXPECT_THAT(trajectory.timestamps, ElementsAre(0, 1));
  EXPECT_EQ(trajectory.poses[1].translation(), Eigen::Vector2d(3, 4));
  EXPECT_EQ(trajectory.poses[1].angle(), 0.5);
  EXPECT_THAT(file.report.notes, ElementsAre(Pair("heading not known", 1)));
}

TEST(ReadTrajectory, VerticesOfAPoseGraphOrItsOdometry) {
  const auto vertices = parse_trajectory("VERTEX_SE2 0 1 2 0\nVERTEX_SE2 1 3 4 0\n");
  EXPECT_EQ(std::get<Trajectory<Pose2>>(vertices.trajectory).poses[1].translation().x(), 3);
  const auto chained =
      parse_trajectory("EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n");
  const auto& poses = std::get<Trajectory<Pose2>>(chained.trajectory).poses;
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[2].translation().x(), 2);
}

TEST(ReadTrajectory, RepairsRotationsAndCounts) {
  const auto file =
      parse_trajectory("1 0 0 1 0 1.0001 0 2 0 0 1 3\n1 0 0 1 0 1.000001 0 2 0 0 1 3\n");
  EXPECT_THAT(file.report.repairs, ElementsAre(Pair("rotation matrix orthonormalised", 1)));
  EXPECT_THAT(file.report.notes, ElementsAre(Pair("rotation matrix rounded", 1)));
  EXPECT_THROW(parse_trajectory("1 0 0 1 0 1.0001 0 2 0 0 1 3\n", true), ParseError);
}

TEST(ReadTrajectory, LocatesErrors) {
  const std::string expected =
      "; expected a trajectory in TUM, KITTI or EuRoC format, rows of time x y theta, or a pose "
      "graph";
  EXPECT_EQ(trajectory_error(""), "f: the file is empty" + expected);
  EXPECT_EQ(trajectory_error("1 2 3 4 5\n"), "f: unknown format" + expected);
  EXPECT_EQ(trajectory_error("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0\n"),
            "f:2:14: expected qw, found the end of the line");
  EXPECT_EQ(trajectory_error("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1 7\n"),
            "f:2:17: expected the end of the line (got '7')");
  EXPECT_EQ(trajectory_error("1 0 0 1 0 1 0 2 0 0 -1 3\n"),
            "f:1:1: expected a rotation matrix, this one is a reflection (got '1 0 0 1 0 1 0 2 0 0 "
            "-1 3')");
}

TEST(ReadTrajectory, NotesStampsThatDoNotIncrease) {
  const auto file = parse_trajectory("1 0 0 0\n1 0 0 0\n0 0 0 0\n");
  EXPECT_THAT(file.report.notes, ElementsAre(Pair("time stamp not increasing", 2)));
}

TEST(WriteTrajectory, EveryFormatReadsBack) {
  const TemporaryFolder folder;
  Trajectory<Pose3> trajectory;
  for (int k = 0; k < 5; ++k) {
    Pose3::Tangent xi;
    xi << 1.0 / 3 * k, 2, 3, 0.1 * k, 0.7, -0.3;
    trajectory.poses.push_back(Pose3::exp(xi));
    trajectory.timestamps.push_back(1403636580.5 + 0.1 * k);
  }
  for (const auto format : {FileFormat::tum, FileFormat::kitti, FileFormat::euroc}) {
    const auto path = folder / std::string(enum_name(format));
    write_trajectory(path, trajectory, format);
    const auto file = read_trajectory(path, {.strict = true});
    EXPECT_EQ(file.report.format, enum_name(format));
    const auto& back = std::get<Trajectory<Pose3>>(file.trajectory);
    ASSERT_EQ(back.poses.size(), trajectory.poses.size());
    for (std::size_t k = 0; k < back.poses.size(); ++k) {
      EXPECT_EQ(back.poses[k].translation(), trajectory.poses[k].translation());
      EXPECT_LT(back.poses[k].rotation().angularDistance(trajectory.poses[k].rotation()), 1e-15);
      if (format != FileFormat::kitti) {
        EXPECT_NEAR(back.timestamps[k], trajectory.timestamps[k], 5e-7);
      }
    }
  }
}

TEST(WriteTrajectory, LiftsPlanarPosesAndNumbersThem) {
  const TemporaryFolder folder;
  const Trajectory<Pose2> trajectory{{Pose2(1, 2, 0), Pose2(3, 4, 0)}, {}};
  write_trajectory(folder / "a", trajectory, FileFormat::tum);
  EXPECT_EQ(read_file(folder / "a"), "0 1 2 0 0 0 0 1\n1 3 4 0 0 0 0 1\n");
  write_trajectory(folder / "b", trajectory, FileFormat::planar);
  EXPECT_EQ(read_file(folder / "b"), "0 1 2 0\n1 3 4 0\n");
  EXPECT_THROW(write_trajectory(folder / "c", trajectory, FileFormat::g2o), InvalidArgument);
  EXPECT_THROW(write_trajectory(folder / "c", Trajectory<Pose3>(), FileFormat::planar),
               InvalidArgument);
  EXPECT_THROW(
      write_trajectory(folder / "c", Trajectory<Pose2>{{Pose2()}, {1, 2}}, FileFormat::tum),
      InvalidArgument);
  EXPECT_FALSE(std::filesystem::exists(folder / "c"));
}

struct RealFile {
  const char* name;
  const char* format;
  std::size_t poses;

  friend void PrintTo(const RealFile& file, std::ostream* out) { *out << file.name; }
};

class RealTrajectory : public testing::TestWithParam<RealFile> {};

TEST_P(RealTrajectory, Reads) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, GetParam().name);
  const auto file = read_trajectory(path.string());
  EXPECT_EQ(file.report.format, GetParam().format);
  std::visit([](const auto& t) { EXPECT_EQ(t.poses.size(), GetParam().poses); }, file.trajectory);
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealTrajectory,
    testing::Values(RealFile{"paper/kitti/poses_00.txt", "kitti", 4541},
                    RealFile{"paper/kitti/poses_02.txt", "kitti", 4661},
                    RealFile{"paper/kitti/poses_06.txt", "kitti", 1101},
                    RealFile{"paper/kitti/poses_07.txt", "kitti", 1101},
                    RealFile{"paper/kitti/poses_09.txt", "kitti", 1591},
                    RealFile{"paper/kitti/KITTI_00_ORB.txt", "kitti", 4541},
                    RealFile{"paper/b25b/Bicocca_2009-02-25b-GT-extended.csv", "planar", 6580},
                    RealFile{"paper/b25b/Bicocca25b_GT_GPS.g2o", "g2o", 6580},
                    RealFile{"posegraph2d/ring/groundTruth/poses.txt", "planar", 434},
                    RealFile{"posegraph2d/ringCity/groundTruth/poses.txt", "planar", 2361},
                    RealFile{"placerec/tuc_corridor/Corridor_GT.txt", "points", 11346},
                    RealFile{"snl/labyrinth_uwb/Indoor_UWB_GT.txt", "points", 233},
                    RealFile{"posegraph2d/city10000/city10000_groundtruth.txt", "toro", 10000},
                    RealFile{"posegraph3d/sphere2500/sphere2500_groundtruth.txt", "toro", 2500}));

}  // namespace
}  // namespace isotherm::slam
