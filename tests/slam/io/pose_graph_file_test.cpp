#include "isotherm/slam/io/pose_graph_file.hpp"

#include <bit>
#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/text_writer.hpp"
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

PoseGraphFile parse_graph(const std::string& text, bool strict = false) {
  TextReader reader("f.g2o", text);
  return read_pose_graph(reader, {.strict = strict});
}

PoseGraph<Pose2> planar(const std::string& text) {
  return std::get<PoseGraph<Pose2>>(parse_graph(text).graph);
}

PoseGraph<Pose3> spatial(const std::string& text) {
  return std::get<PoseGraph<Pose3>>(parse_graph(text).graph);
}

std::string graph_error(const std::string& text, bool strict = false) {
  return isotherm_test::parse_error_of([&] { parse_graph(text, strict); });
}

template <class Pose>
std::vector<double> values(const PoseGraph<Pose>& graph) {
  std::vector<double> all;
  const auto add = [&](const auto& block) { all.insert(all.end(), block.begin(), block.end()); };
  const auto add_pose = [&](const Pose& pose) {
    add(pose.translation());
    if constexpr (Pose::kDim == 2) {
      all.push_back(pose.angle());
    } else {
      add(pose.rotation().coeffs());
    }
  };
  for (const auto& pose : graph.poses) add_pose(pose);
  for (const auto& constraint : graph.constraints) {
    add_pose(constraint.T_from_to);
    add(constraint.information.reshaped());
  }
  return all;
}

template <class Pose>
void expect_identical(const PoseGraph<Pose>& a, const PoseGraph<Pose>& b) {
  EXPECT_EQ(a.ids, b.ids);
  EXPECT_EQ(a.fixed, b.fixed);
  ASSERT_EQ(a.constraints.size(), b.constraints.size());
  for (std::size_t k = 0; k < a.constraints.size(); ++k) {
    ASSERT_EQ(a.constraints[k].from, b.constraints[k].from);
    ASSERT_EQ(a.constraints[k].to, b.constraints[k].to);
  }
  const auto left = values(a);
  const auto right = values(b);
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(left[i]), std::bit_cast<std::uint64_t>(right[i])) << i;
  }
}

void expect_round_trip(const AnyPoseGraph& graph) {
  const TemporaryFolder folder;
  write_g2o(folder / "a.g2o", graph);
  const auto back = read_pose_graph(folder / "a.g2o", {.strict = true});
  ASSERT_EQ(back.graph.index(), graph.index());
  std::visit(
      [&](const auto& g) { expect_identical(g, std::get<std::decay_t<decltype(g)>>(back.graph)); },
      graph);
}

TEST(ReadPoseGraph, SwitchableEdgesAreLoops) {
  const auto file = parse_graph(
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 2 2 0 0\nVERTEX_SWITCH 3 1\n"
      "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SWITCH_PRIOR 3 1 1.0\n"
      "EDGE_SE2_SWITCHABLE 0 2 3 2 0 0.5 4 0 0 4 0 9\n"
      "EDGE_SE2_SWITCHABLE 1 2 4 1 0 0.5 4 0 0 4 0 9\n"
      "EDGE_SE2_MAXMIX 0 2 0.01 2 0 0.5 4 0 0 4 0 9\n");
  const auto graph = std::get<PoseGraph<Pose2>>(file.graph);
  ASSERT_EQ(graph.constraint_count(), 4);
  EXPECT_THAT(edge_roles(graph).candidates, ElementsAre(1, 2, 3)) << "even between neighbours";
  EXPECT_EQ(graph.constraints[1].T_from_to.translation().x(), 2.0);
  EXPECT_EQ(graph.constraints[1].T_from_to.angle(), 0.5);
  EXPECT_EQ(graph.constraints[1].information(2, 2), 9.0);
  EXPECT_THAT(file.report.notes, ElementsAre(Pair("switchable edge", 3)));
  EXPECT_THAT(file.report.skipped,
              ElementsAre(Pair("EDGE_SWITCH_PRIOR", 1), Pair("VERTEX_SWITCH", 1)));
  EXPECT_THAT(file.other_lines, IsEmpty()) << "switches of edges that are no longer theirs";
  const auto space = spatial(
      "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n"
      "EDGE_SE3_SWITCHABLE 0 1 7 2 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n");
  EXPECT_EQ(space.constraints[1].T_from_to.translation().x(), 2.0);
  EXPECT_EQ(graph_error("EDGE_SE2_SWITCHABLE 0 2 x 2 0 0 4 0 0 4 0 9\n"),
            "f.g2o:1:25: expected a switch or a weight, a finite number (got 'x')");
}

TEST(ReadPoseGraph, LinkTypesSayWhatIsOdometry) {
  const auto graph = planar(
      "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1 0\nEDGE_SE2 2 3 1 0 0 1 0 0 1 0 1 1\n"
      "EDGE_SE2 2 3 1 0 0 1 0 0 1 0 1 0\nEDGE_SE2 3 1 1 0 0 1 0 0 1 0 1 6\n"
      "EDGE_SE2 1 3 1 0 0 1 0 0 1 0 1 4\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1 0\n"
      "EDGE_SE2 3 4 1 0 0 1 0 0 1 0 1\n");
  const auto roles = edge_roles(graph);
  EXPECT_THAT(roles.odometry, ElementsAre(0, 2, 3, 6));
  EXPECT_THAT(roles.candidates, ElementsAre(1, 4, 5));
  for (const char* type : {"7", "-1", "0.5", "1 1"}) {
    EXPECT_THAT(graph_error(std::string("EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1 ") + type + "\n"),
                testing::HasSubstr("expected the end of the line"));
  }
}

TEST(ReadPoseGraph, NamesWhatIsNotUsed) {
  const auto report = parse_graph(
                          "VERTEX_SE2 0 0 0 0\nVERTEX_XY 1 2 3\nVERTEX_XY 2 2 3\n"
                          "EDGE_PRIOR_SE2 0 0 0 0 1 0 0 1 0 1\nODD 1\n")
                          .report;
  EXPECT_THAT(report.notes, ElementsAre(Pair("unknown record", 1), Pair("unused EDGE_PRIOR_SE2", 1),
                                        Pair("unused VERTEX_XY", 1)));
  EXPECT_EQ(report.diagnostics[0].message, "a landmark; kept as it stands but not used");
  EXPECT_EQ(report.diagnostics[1].message, "a prior on a pose; kept as it stands but not used");
}

TEST(ReadPoseGraph, PlanarRecords) {
  const auto graph = planar(
      "# comment\n"
      "VERTEX_SE2 0 0 0 0\r\n"
      "VERTEX_SE2 5 1.5\t-2 0.25\r\n"
      "FIX 0\n"
      "EDGE_SE2 5 0 1 2 3 10 1 2 20 3 30");
  EXPECT_THAT(graph.ids, ElementsAre(0, 5));
  EXPECT_THAT(graph.fixed, ElementsAre(0));
  EXPECT_EQ(graph.poses[1].translation(), Eigen::Vector2d(1.5, -2));
  EXPECT_EQ(graph.poses[1].angle(), 0.25);
  ASSERT_EQ(graph.constraint_count(), 1);
  const auto& edge = graph.constraints[0];
  EXPECT_EQ(edge.from, 1);
  EXPECT_EQ(edge.to, 0);
  EXPECT_EQ(edge.line, 5u);
  EXPECT_EQ(edge.T_from_to.angle(), 3.0);
  Eigen::Matrix3d information;
  information << 10, 1, 2, 1, 20, 3, 2, 3, 30;
  EXPECT_EQ(edge.information, information);
}

// Entry k of the upper triangle by rows is k, plus 100 on the diagonal to make
// the matrix definite; the sum of every product was worked out by hand.
TEST(ReadPoseGraph, EdgesWithoutTags) {
  const auto file =
      parse_graph("# from to x y theta\n0 1 1.5 0 0.5 4 1 2 5 3 6\n1 2 1 0 0 4 0 0 5 0 6\n");
  EXPECT_EQ(file.report.format, "edge-rows");
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  ASSERT_EQ(graph.constraint_count(), 2);
  EXPECT_EQ(graph.constraints[0].T_from_to.translation()[0], 1.5);
  EXPECT_EQ(graph.constraints[0].information(0, 2), 2.0);
  EXPECT_EQ(graph.constraints[0].information(1, 2), 3.0);
  EXPECT_EQ(graph.constraints[0].line, 2u);
}

TEST(ReadPoseGraph, SpatialInformationKeepsItsOrder) {
  const auto graph = spatial(
      "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1 "
      "101 2 3 4 5 6 107 8 9 10 11 112 13 14 15 116 17 18 119 20 121\n");
  const auto& edge = graph.constraints[0];
  Pose3::Matrix expected;
  expected << 101, 2, 3, 4, 5, 6,  //
      2, 107, 8, 9, 10, 11,        //
      3, 8, 112, 13, 14, 15,       //
      4, 9, 13, 116, 17, 18,       //
      5, 10, 14, 17, 119, 20,      //
      6, 11, 15, 18, 20, 121;
  EXPECT_EQ(edge.information, expected);

  Pose3::Tangent xi;
  xi << 1, 2, 3, 0.1, 0.2, 0.3;
  const auto r = residual(edge, Pose3(), Pose3::exp(xi));
  // diagonal: 101 + 4*107 + 9*112 + .01*116 + .04*119 + .09*121           = 1553.81
  // 2 * translation pairs: 2*(2*2 + 3*3 + 6*8)                            = 122
  // 2 * mixed: 2*(.4 + 1.0 + 1.8 + 1.8 + 4.0 + 6.6 + 3.9 + 8.4 + 13.5)    = 82.8
  // 2 * rotation pairs: 2*(.02*17 + .03*18 + .06*20)                      = 4.16
  EXPECT_NEAR(r.dot(edge.information * r), 1762.77, 1e-9);
}

TEST(ReadPoseGraph, WithoutVertexLinesThereAreNoPoses) {
  const auto graph = planar("EDGE_SE2 7 3 1 0 0 1 0 0 1 0 1\nEDGE_SE2 3 9 1 0 0 1 0 0 1 0 1\n");
  EXPECT_THAT(graph.ids, ElementsAre(3, 7, 9));
  EXPECT_THAT(graph.poses, IsEmpty());
  EXPECT_EQ(graph.constraints[0].from, 1);
  expect_round_trip(graph);
}

TEST(ReadPoseGraph, PlacesVerticesWithoutALine) {
  const std::string text =
      "VERTEX_SE2 0 1 0 0\n"
      "EDGE_SE2 2 1 1 0 0 1 0 0 1 0 1\n"
      "EDGE_SE2 0 2 2 0 0 1 0 0 1 0 1\n"
      "EDGE_SE2 8 9 5 0 0 1 0 0 1 0 1\n";
  const auto file = parse_graph(text);
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  ASSERT_THAT(graph.ids, ElementsAre(0, 1, 2, 8, 9));
  EXPECT_EQ(graph.poses[2].translation().x(), 3.0);
  EXPECT_EQ(graph.poses[1].translation().x(), 4.0);
  EXPECT_EQ(graph.poses[3].translation().x(), 0.0);
  EXPECT_EQ(graph.poses[4].translation().x(), 5.0);
  EXPECT_THAT(file.report.repairs, ElementsAre(Pair("vertex placed", 4)));
  EXPECT_EQ(to_string(file.report.diagnostics[0]),
            "f.g2o:3: vertex has no line of its own; placed by this edge (got '2')");
  EXPECT_EQ(graph_error(text, true),
            "f.g2o:3: vertex has no line of its own; placed by this edge (got '2')");
}

TEST(ReadPoseGraph, RepairsAnglesAndQuaternionsAndCounts) {
  const auto planar_file = parse_graph("VERTEX_SE2 0 0 0 7\nVERTEX_SE2 1 0 0 3.141593\n");
  const auto& poses = std::get<PoseGraph<Pose2>>(planar_file.graph).poses;
  EXPECT_EQ(poses[0].angle(), wrap_angle(7));
  EXPECT_LT(poses[1].angle(), 0);
  EXPECT_THAT(planar_file.report.repairs, ElementsAre(Pair("angle wrapped", 1)));
  EXPECT_THAT(planar_file.report.notes, ElementsAre(Pair("angle rounded", 1)));
  EXPECT_EQ(graph_error("VERTEX_SE2 0 0 0 7\n", true),
            "f.g2o:1:18: angle outside [-pi, pi]; wrapped (got '7')");

  const auto file = parse_graph(
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1.001\nVERTEX_SE3:QUAT 1 0 0 0 0.6 0 0 0.800001\n");
  const auto& rotations = std::get<PoseGraph<Pose3>>(file.graph).poses;
  EXPECT_EQ(rotations[0].rotation().w(), 1.0);
  EXPECT_NEAR(rotations[1].rotation().norm(), 1.0, 1e-15);
  EXPECT_THAT(file.report.repairs, ElementsAre(Pair("quaternion normalised", 1)));
  EXPECT_THAT(file.report.notes, ElementsAre(Pair("quaternion rounded", 1)));
  expect_round_trip(file.graph);
  EXPECT_EQ(graph_error("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0.5\n"),
            "f.g2o:1:25: expected a unit quaternion, its norm is 0.5 (got '0 0 0 0.5')");
}

TEST(ReadPoseGraph, ReplacesIndefiniteInformationByTheMedianOfItsKind) {
  const std::string text =
      "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n"
      "EDGE_SE2 1 2 1 0 0 9 0 0 9 0 9\n"
      "EDGE_SE2 2 3 1 0 0 4 0 0 4 0 4\n"
      "EDGE_SE2 3 4 1 0 0 1 2 0 1 0 1\n"
      "EDGE_SE2 0 4 1 0 0 -7 0 0 7 0 7\n"
      "EDGE_SE2 0 3 1 0 0 50 0 0 50 0 50\n";
  const auto file = parse_graph(text);
  const auto& constraints = std::get<PoseGraph<Pose2>>(file.graph).constraints;
  EXPECT_EQ(constraints[3].information, 4.0 * Eigen::Matrix3d::Identity());
  EXPECT_EQ(constraints[4].information, 50.0 * Eigen::Matrix3d::Identity());
  EXPECT_THAT(file.report.repairs, ElementsAre(Pair("information replaced", 2)));
  EXPECT_EQ(to_string(file.report.diagnostics[0]),
            "f.g2o:4:20: information matrix of this odometry edge is not positive semi-definite; "
            "replaced by the median, from line 3 (got '1 2 0 1 0 1')");
  EXPECT_THAT(graph_error(text, true), testing::StartsWith("f.g2o:4:20: "));
  EXPECT_EQ(graph_error("EDGE_SE2 0 1 1 0 0 -1 0 0 1 0 1\n"),
            "f.g2o:1:20: information matrix is not positive semi-definite, and no edge has one "
            "that could stand in (got '-1 0 0 1 0 1')");
}

TEST(ReadPoseGraph, SingularInformationIsLeftAlone) {
  const auto file = parse_graph(
      "EDGE_SE2 0 1 1 0 0 1 1 0 1 0 0\n"
      "EDGE_SE2 1 2 1 0 0 0 0 0 0 0 0\n");
  EXPECT_THAT(file.report.repairs, IsEmpty());
  EXPECT_EQ(std::get<PoseGraph<Pose2>>(file.graph).constraints[0].information(0, 1), 1.0);
}

TEST(ReadPoseGraph, SortsVerticesByIdAndRefusesRepeats) {
  const std::string text = "VERTEX_SE2 2 2 0 0\nVERTEX_SE2 1 1 0 0\n";
  const auto file = parse_graph(text);
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  EXPECT_THAT(graph.ids, ElementsAre(1, 2));
  EXPECT_EQ(graph.poses[0].translation().x(), 1.0);
  EXPECT_EQ(to_string(file.report.diagnostics[0]),
            "f.g2o:2: vertex id out of place after 2; sorted by id (got '1')");
  EXPECT_EQ(graph_error("VERTEX_SE2 1 0 0 0\nVERTEX_SE2 2 0 0 0\nVERTEX_SE2 1 0 0 0\n"),
            "f.g2o:3: vertex already given at line 1 (got '1')");
}

TEST(ReadPoseGraph, ToroRecords) {
  const auto file =
      parse_graph("VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0\nEDGE2 0 1 1 0 0 10 1 20 30 2 3\n");
  EXPECT_EQ(file.report.format, "toro");
  Eigen::Matrix3d information;
  information << 10, 1, 2, 1, 20, 3, 2, 3, 30;
  EXPECT_EQ(std::get<PoseGraph<Pose2>>(file.graph).constraints[0].information, information);

  const auto by_rows = parse_graph("EDGE2 0 1 1 0 0 10 0 0 20 0 30\n");
  EXPECT_EQ(std::get<PoseGraph<Pose2>>(by_rows.graph).constraints[0].information,
            Eigen::Matrix3d(Eigen::Vector3d(10, 20, 30).asDiagonal()));
  EXPECT_THAT(by_rows.report.repairs, ElementsAre(Pair("information reordered", 1)));

  const auto graph = spatial(
      "VERTEX3 0 1 2 3 0 0 0.5\n"
      "EDGE3 0 1 1 0 0 0.1 0.2 0.3 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n");
  EXPECT_NEAR(graph.poses[0].rotation().z(), std::sin(0.25), 1e-15);
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Matrix3d expected =
      (AngleAxisd(0.3, Vector3d::UnitZ()) * AngleAxisd(0.2, Vector3d::UnitY()) *
       AngleAxisd(0.1, Vector3d::UnitX()))
          .toRotationMatrix();
  EXPECT_LT((graph.constraints[0].T_from_to.rotation_matrix() - expected).norm(), 1e-14);
}

TEST(ReadPoseGraph, PosesOfAPyfgFile) {
  const auto file = parse_graph(
      "VERTEX_SE2 10.5 A0 1 2 0.5\n"
      "VERTEX_SE2 11.5 A1 3 4 0.5\n"
      "VERTEX_XY L0 4 6\n"
      "EDGE_SE2 10.5 A0 A1 2 2 0 0.25 0 0 0.25 0 0.0625\n"
      "EDGE_RANGE 10.5 A0 L0 5.1 0.04\n");
  EXPECT_EQ(file.report.format, "pyfg");
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  const VertexId a0 = VertexId{'A'} << 56;
  EXPECT_THAT(graph.ids, ElementsAre(a0, a0 + 1));
  EXPECT_EQ(graph.constraints[0].information,
            Eigen::Matrix3d(Eigen::Vector3d(4, 4, 16).asDiagonal()));
  EXPECT_THAT(file.report.skipped, ElementsAre(Pair("EDGE_RANGE", 1), Pair("VERTEX_XY", 1)));
  EXPECT_THAT(file.other_lines, IsEmpty());
  EXPECT_EQ(graph_error("VERTEX_SE2 1 A0 0 0 0\nVERTEX_SE2 1 7 0 0 0\n"),
            "f.g2o:2:14: expected a vertex id, a letter and a number below 2^56 (got '7')");
}

TEST(ReadPoseGraph, KeepsWhatItDoesNotKnow) {
  const std::string text =
      "# a comment\n"
      "VERTEX_SE2 0 0 0 0\n"
      "VERTEX_XY 7 1 2\n"
      "EDGE_SE2_XY 0 7 1 2 1 0 1\n";
  const auto file = parse_graph(text);
  EXPECT_THAT(file.report.skipped, ElementsAre(Pair("EDGE_SE2_XY", 1), Pair("VERTEX_XY", 1)));
  EXPECT_THAT(file.report.records, ElementsAre(Pair("VERTEX_SE2", 1)));
  const TemporaryFolder folder;
  write_g2o(folder / "a.g2o", file);
  EXPECT_EQ(read_file(folder / "a.g2o"),
            "VERTEX_SE2 0 0 0 0\n# a comment\nVERTEX_XY 7 1 2\nEDGE_SE2_XY 0 7 1 2 1 0 1\n");
}

TEST(ReadPoseGraph, KeysOf64Bits) {
  const auto graph = spatial(
      "EDGE_SE3:QUAT 6989586621679009792 18446744073709551615 0 0 0 0 0 0 1 "
      "1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n");
  EXPECT_THAT(graph.ids, ElementsAre(6989586621679009792u, 18446744073709551615u));
  expect_round_trip(graph);
}

TEST(ReadPoseGraph, LocatesErrors) {
  EXPECT_EQ(graph_error(""),
            "f.g2o: the file is empty; expected a pose graph in g2o, TORO or PyFG format");
  EXPECT_EQ(graph_error("# nothing\n\n"),
            "f.g2o: no vertex and no edge; expected a pose graph in g2o, TORO or PyFG format");
  EXPECT_EQ(graph_error("EDGE_SE2 0 1 1 0 0 1 0 0 1 0\n"),
            "f.g2o:1:29: expected an information entry, found the end of the line");
  EXPECT_EQ(graph_error("VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 1 nan 0 1 0 0 1 0 1\n"),
            "f.g2o:2:16: expected y, a finite number (got 'nan')");
  EXPECT_EQ(graph_error("VERTEX_SE2 x 0 0 0\n"),
            "f.g2o:1:12: expected a vertex id, an integer in [0, 2^64) (got 'x')");
  EXPECT_EQ(graph_error("VERTEX_SE2 0 0 0 0 0\n"),
            "f.g2o:1:20: expected the end of the line (got '0')");
  EXPECT_EQ(graph_error("VERTEX_SE2 0 0 0 0\nFIX 3\n"),
            "f.g2o:2:5: fixed vertex does not exist (got '3')");
  EXPECT_EQ(graph_error("VERTEX_SE2 0 0 0 0\n0 1 2\n"),
            "f.g2o:2:1: expected a record tag such as VERTEX_SE2 or EDGE_SE3:QUAT (got '0')");
  EXPECT_EQ(graph_error("VERTEX_SE2 0 0 0 0\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n"),
            "f.g2o:2:1: spatial record in a file of planar poses (got 'VERTEX_SE3:QUAT')");
}

TEST(WriteG2o, RefusesWhatCannotBeReadBack) {
  const TemporaryFolder folder;
  PoseGraph<Pose2> graph;
  graph.ids = {0};
  graph.poses = {Pose2(std::nan(""), 0, 0)};
  EXPECT_THROW(write_g2o(folder / "a.g2o", graph), InvalidArgument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

class RealPoseGraph : public testing::TestWithParam<std::string> {};

TEST_P(RealPoseGraph, RoundTripsToTheLastBit) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, GetParam());
  expect_round_trip(read_pose_graph(path.string()).graph);
}

INSTANTIATE_TEST_SUITE_P(Files, RealPoseGraph,
                         testing::Values("paper/b25b/B25b_0.000.g2o", "paper/kitti/kitti_06.g2o",
                                         "posegraph2d/intel/intel.g2o",
                                         "posegraph2d/CSAIL/CSAIL.g2o",
                                         "posegraph3d/sphere2500/sphere2500.g2o",
                                         "posegraph3d/parking-garage/parking-garage.g2o",
                                         "posegraph3d/torus3D/torus3D.g2o.gz",
                                         "multirobot/doorslam_argos_4robots/clean/0.g2o"));

}  // namespace
}  // namespace isotherm::slam
