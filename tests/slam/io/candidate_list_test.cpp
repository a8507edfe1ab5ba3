#include "isotherm/slam/io/candidate_list.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm_test/parse_error.hpp"
#include "isotherm_test/temporary.hpp"

namespace isotherm::slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class CandidateList : public testing::Test {
 protected:
  std::vector<PlacePair> read(const std::string& text) {
    isotherm_test::write_file(folder_ / "list", text);
    return read_place_pairs(folder_ / "list");
  }
  std::string error(const std::string& text) {
    return isotherm_test::parse_error_of([&] { read(text); });
  }

  isotherm_test::TemporaryFolder folder_;
};

PoseGraph<Pose2> line(int poses) {
  PoseGraph<Pose2> graph;
  for (int v = 0; v < poses; ++v) graph.ids.push_back(static_cast<VertexId>(v));
  return graph;
}

TEST_F(CandidateList, RowsAreQueriesAndTheirCandidatesBestFirst) {
  const auto pairs = read("# SSC\n40 3 4 5\n41,6\n");
  ASSERT_EQ(pairs.size(), 4u);
  EXPECT_EQ(pairs[2].from, 40u);
  EXPECT_EQ(pairs[2].to, 5u);
  EXPECT_EQ(pairs[2].rank, 2u);
  EXPECT_EQ(pairs[3].line, 3u);
  EXPECT_THAT(error("1 x\n"), HasSubstr("expected the number of a pose that looks like it"));
  EXPECT_THAT(error("1\n"), HasSubstr("no pair"));
}

TEST_F(CandidateList, NamedColumnsMayHaveTransforms) {
  const auto planar = read("score,from,to,x,y,theta\n0.9,40,3,1,2,0.5\n0.8,40,4,0,0,0\n");
  ASSERT_EQ(planar.size(), 2u);
  EXPECT_THAT(planar[0].transform, ElementsAre(1, 2, 0.5));
  EXPECT_EQ(planar[1].rank, 1u);
  EXPECT_EQ(read("from,to,x,y,z,qx,qy,qz,qw\n1,9,1,2,3,0,0,0,1\n")[0].transform.size(), 7u);
  EXPECT_THAT(error("from,to,x,y,z,qx,qy,qz,qw\n1,9,1,2,3,0,0,0,2\n"),
              HasSubstr("expected a unit quaternion"));
  EXPECT_THAT(error("a,b\n1,2\n"), HasSubstr("expected a column named 'from'"));
}

TEST_F(CandidateList, UnknownTransformsAreNearIdentity) {
  auto graph = line(50);
  const auto left_out =
      add_place_pairs(graph, read("40 3 4 5 39\n30 2\n"), {.sigma = 2.0, .top = 2}, "list");
  EXPECT_EQ(left_out, 2u);
  ASSERT_EQ(graph.constraint_count(), 3);
  EXPECT_EQ(graph.constraints[0].information.diagonal(), Eigen::Vector3d(0.25, 0.25, 0.0));
  EXPECT_EQ(graph.constraints[0].T_from_to.translation(), Eigen::Vector2d(0, 0));
  EXPECT_THAT(edge_roles(graph).candidates, ElementsAre(0, 1, 2));
  graph = line(50);
  EXPECT_EQ(add_place_pairs(graph, read("40 39\n"), {}, "list"), 1u) << "too near";
  add_place_pairs(graph, read("from,to,x,y,theta\n40,3,1,2,0.5\n"),
                  {.transform_sigma = 0.5, .transform_turn_sigma = 0.25}, "list");
  EXPECT_EQ(graph.constraints[0].information.diagonal(), Eigen::Vector3d(4, 4, 16));
  EXPECT_EQ(graph.constraints[0].T_from_to.angle(), 0.5);
}

TEST_F(CandidateList, WhatOdometryDoesNotHaveIsTold) {
  auto graph = line(10);
  const auto pairs = read("\n9 77\n");
  EXPECT_EQ(isotherm_test::parse_error_of([&] { add_place_pairs(graph, pairs, {}, "list"); }),
            "list:2: odometry has no such pose (got '77')");
  const auto spatial = read("from,to,x,y,z,qx,qy,qz,qw\n1,9,1,2,3,0,0,0,1\n");
  EXPECT_THAT(isotherm_test::parse_error_of([&] { add_place_pairs(graph, spatial, {}, "list"); }),
              HasSubstr("expected x,y,theta: odometry is in the plane"));
}

}  // namespace
}  // namespace isotherm::slam
