#include "isotherm/slam/graph/trusted_edges.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam {
namespace {

using testing::ElementsAre;

class TrustedEdges : public testing::Test {
 protected:
  TrustedEdges() {
    graph.ids = {10, 11, 12, 13};
    graph.constraints = {{0, 1, Pose2(1, 0, 0)},
                         {1, 2, Pose2(1, 0, 0)},
                         {2, 3, Pose2(1, 0, 0)},
                         {3, 0, Pose2(-3, 0, 0)},
                         {0, 2, Pose2(7, 7, 1)}};
  }
  ~TrustedEdges() override { std::filesystem::remove(path); }

  EdgeRoles read(const std::string& text) const {
    std::ofstream(path) << text;
    return read_trusted_edges(path, graph);
  }

  std::string path = (std::filesystem::temp_directory_path() /
                      ("isotherm.trusted." + std::to_string(getpid()) + ".csv"))
                         .string();
  PoseGraph<Pose2> graph;
};

TEST_F(TrustedEdges, ByNumberOrByEnds) {
  const auto roles = read("edge\n0\n1\n3\n");
  EXPECT_THAT(roles.odometry, ElementsAre(0, 1, 3));
  EXPECT_THAT(roles.candidates, ElementsAre(2, 4));
  EXPECT_EQ(read("0\n1\n3\n").odometry, roles.odometry);
  EXPECT_EQ(read("from,to\n10,11\n12,11\n10,13\n").odometry, roles.odometry);
  EXPECT_EQ(read("10,11\n11,12\n13,10\n").odometry, roles.odometry);
  EXPECT_TRUE(read("").odometry.empty());
}

TEST_F(TrustedEdges, RowsWithoutAnEdgeAreErrors) {
  EXPECT_THROW(read("edge\n5\n"), ParseError);
  EXPECT_THROW(read("edge\n-1\n"), ParseError);
  EXPECT_THROW(read("from,to\n10,99\n"), ParseError);
}

TEST_F(TrustedEdges, TrustedLoopsAreNotJudgedAndDoNotJoinTheChain) {
  const auto roles = read("edge\n0\n1\n2\n3\n");
  EXPECT_EQ(OdometryChain<Pose2>(graph, roles).chain_count(), 1);
  const auto result = prune(graph, roles, Chi2PruneOptions{});
  ASSERT_EQ(result.verdicts.size(), 1u);
  EXPECT_EQ(result.verdicts[0].edge, 4);
  EXPECT_EQ(result.verdicts[0].verdict, spectral::Verdict::prune);
}

}  // namespace
}  // namespace isotherm::slam
