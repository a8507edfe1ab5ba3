#include "isotherm/slam/graph/any_pose_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/optimize/optimize.hpp"

namespace isotherm::slam {
namespace {

PoseGraphFile planar_file() {
  TextReader reader("planar.g2o",
                    "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n");
  return read_pose_graph(reader);
}

TEST(AnyPoseGraph, GivesTheTypeThatItHas) {
  auto file = planar_file();
  EXPECT_EQ(as<Pose2>(file).vertex_count(), 3);
  as<Pose2>(file).fixed = {1};
  EXPECT_EQ(as<Pose2>(file.graph).fixed.size(), 1u);
  const PoseGraph<Pose2> taken = as<Pose2>(planar_file());
  EXPECT_EQ(taken.constraint_count(), 2);
}

TEST(AnyPoseGraph, RefusesTheOtherTypeInItsOwnWords) {
  const auto file = planar_file();
  try {
    as<Pose3>(file);
    FAIL() << "a planar graph passed for a spatial one";
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("ask for it as one of Pose2"));
  }
}

TEST(AnyPoseGraph, IsOptimisedAsItStands) {
  const auto file = planar_file();
  const auto any = optimize(file);
  const auto typed = optimize(as<Pose2>(file));
  EXPECT_EQ(any.status, typed.status);
  EXPECT_EQ(as<Pose2>(any.graph).poses[2].translation(), typed.poses[2].translation());
  EXPECT_EQ(as<Pose2>(any.graph).constraint_count(), 2);
}

}  // namespace
}  // namespace isotherm::slam
