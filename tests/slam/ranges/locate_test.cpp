#include "isotherm/slam/ranges/locate.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/ranges/range_robots.hpp"
#include "slam/ranges/range_graphs.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::error_from_first_pose;
using isotherm_test::RangeWorld;
using isotherm_test::simulated_ranges;
using network::LocalizeStatus;
using network::NodeStatus;
using spectral::Verdict;

template <class Pose>
void expect_located(const RangeWorld& world) {
  const auto graph = simulated_ranges<Pose>(world);
  const auto result = locate(graph, {});
  EXPECT_EQ(result.status, LocalizeStatus::converged);
  EXPECT_EQ(result.count(NodeStatus::localised), graph.node_count());
  EXPECT_GE(count(result.verdicts, Verdict::keep), world.ranges * 19 / 20);
  EXPECT_NEAR(result.errors.scale, 1.0, 0.25);
  EXPECT_FALSE(result.anchored);
  // No worse than from the truth.
  const auto from_truth = locate(graph, {}, {.start = RangeStart::file});
  EXPECT_LT(result.cost, from_truth.cost + 0.1);
  EXPECT_LT(error_from_first_pose(graph, result.poses),
            1.05 * error_from_first_pose(graph, from_truth.poses) + 0.01);
}

TEST(Locate, ARobotAndItsBeacons) {
  expect_located<Pose2>({});
  expect_located<Pose3>({.ranges = 300});
}

TEST(Locate, RobotsJoinedByRangesAlone) {
  expect_located<Pose2>({.robots = 3, .poses = 80, .beacons = 0, .ranges = 400});
  expect_located<Pose3>({.robots = 2, .poses = 80, .beacons = 0, .ranges = 300});
}

TEST(Locate, FalseAndLongRangesAreFound) {
  auto graph = simulated_ranges<Pose2>({.poses = 300, .ranges = 600});
  const auto clean = locate(graph, {});
  Random random(5);
  const std::size_t n = graph.ranges.size();
  for (std::size_t k = 0; k < n; k += 5) graph.ranges[k].distance = random.uniform(0.0, 60.0);
  for (std::size_t k = 1; k < n; k += 5) {
    graph.ranges[k].distance -= 2.0 * std::log(1.0 - random.uniform());
  }
  const auto result = locate(graph, {});
  std::array<int, 2> wrong{};  // pruned that are correct, kept that are not
  for (std::size_t k = 0; k < n; ++k) {
    const auto& verdict = result.verdicts[k];
    EXPECT_GE(verdict.probability, 0.0);
    EXPECT_LE(verdict.probability, 1.0);
    if (k % 5 >= 2 && verdict.verdict == Verdict::prune) ++wrong[0];
    if (k % 5 == 0 && verdict.verdict == Verdict::keep) ++wrong[1];
  }
  EXPECT_LE(wrong[0], 5);
  EXPECT_LE(wrong[1], 8);
  EXPECT_NEAR(result.errors.too_long, 0.2, 0.06);
  EXPECT_NEAR(result.errors.excess, 2.0, 0.6);
  EXPECT_NEAR(result.errors.anything, 0.2, 0.06);
  EXPECT_LT(error_from_first_pose(graph, result.poses),
            1.5 * error_from_first_pose(graph, clean.poses) + 0.1);
}

TEST(Locate, AConstantOffsetAndAWrongUnitAreLearned) {
  auto graph = simulated_ranges<Pose2>({.poses = 300, .ranges = 600});
  for (auto& range : graph.ranges) range.distance = 3.0 + 1.07 * range.distance;
  const auto result = locate(graph, {});
  EXPECT_TRUE(result.errors.calibrated);
  EXPECT_NEAR(result.errors.offset, 3.0, 0.1);
  EXPECT_NEAR(result.errors.stretch, 1.07, 0.01);
  EXPECT_FALSE(locate(simulated_ranges<Pose2>({}), {}).errors.calibrated);
}

TEST(Locate, AnchorsGiveTheFrame) {
  auto graph = simulated_ranges<Pose2>({});
  const Index beacons = graph.node_count() - 4;
  const auto result = locate(graph, {beacons, beacons + 1, beacons + 2});
  EXPECT_TRUE(result.anchored);
  EXPECT_EQ(result.count(NodeStatus::anchor), 3);
  for (Index v = 0; v < graph.node_count(); ++v) {
    const auto error = (result.poses[v].translation() - graph.positions[v].translation()).norm();
    EXPECT_LT(error, 0.5) << v;
  }
}

TEST(Locate, APriorGivesTheFrame) {
  auto graph = simulated_ranges<Pose2>({});
  graph.priors.push_back({3, graph.positions[3], 1e6 * Eigen::Matrix3d::Identity()});
  const auto result = locate(graph, {});
  EXPECT_TRUE(result.anchored);
  EXPECT_EQ(result.poses.size(), graph.names.size());
  EXPECT_LT((result.poses[3].inverse() * graph.positions[3]).log().norm(), 0.02);
}

TEST(Locate, WhatCannotBePlacedSaysSo) {
  auto graph = simulated_ranges<Pose2>({});
  isotherm_test::add_node(graph, "lone", Pose2(), true, 0.0);
  const Index few = isotherm_test::add_node(graph, "few", Pose2(), true, 0.0);
  graph.ranges.push_back({0, few, 5.0, 0.01});
  const auto result = locate(graph, {});
  EXPECT_EQ(result.nodes[few - 1], NodeStatus::not_connected);
  EXPECT_EQ(result.nodes[few], NodeStatus::not_rigid);
  EXPECT_EQ(result.verdicts.back().verdict, Verdict::ambiguous);
  EXPECT_TRUE(std::isnan(as_localize_result(graph, result).positions(0, few)));
}

TEST(Locate, ABeaconSeenFromALineIsMirrored) {
  RangeGraph<Pose2> graph;
  for (int k = 0; k < 40; ++k) {
    isotherm_test::add_node(graph, "A" + std::to_string(k), Pose2(k, 0.0, 0.0), false, k);
    if (k > 0)
      graph.steps.push_back({k - 1, k, Pose2(1.0, 0.0, 0.0), 1e4 * Eigen::Matrix3d::Identity()});
  }
  const Index beacon = isotherm_test::add_node(graph, "L", Pose2(15.0, 8.0, 0.0), true, 0.0);
  for (Index k = 0; k < 40; ++k) {
    graph.ranges.push_back({k, beacon, std::hypot(k - 15.0, 8.0), 0.01, 1.0 * k});
  }
  const auto result = locate(graph, {});
  EXPECT_EQ(result.nodes[beacon], NodeStatus::mirrored);
  EXPECT_NEAR(std::abs(result.poses[beacon].translation().y()), 8.0, 0.2);
}

TEST(Locate, NothingToLocate) {
  EXPECT_EQ(locate(RangeGraph<Pose2>{}, {}).status, LocalizeStatus::no_start);
  auto graph = simulated_ranges<Pose2>({.poses = 5, .ranges = 1});
  EXPECT_EQ(locate(graph, {}).verdicts.size(), 1u);
  graph.ranges.clear();
  EXPECT_EQ(locate(graph, {}).count(NodeStatus::not_connected), 4);
}

TEST(Locate, TheSameInputGivesTheSameBytes) {
  const auto graph = simulated_ranges<Pose3>({.poses = 60, .ranges = 120});
  const auto first = locate(graph, {});
  const auto second = locate(graph, {}, {}, {.threads = 2});
  for (std::size_t v = 0; v < first.poses.size(); ++v) {
    EXPECT_EQ(first.poses[v].translation(), second.poses[v].translation());
  }
}

TEST(Locate, BadInputIsRefused) {
  const auto good = simulated_ranges<Pose2>({.poses = 10, .ranges = 20});
  auto spoilt = good;
  spoilt.ranges[3].to = 99;
  EXPECT_THROW(locate(spoilt, {}), InvalidArgument);
  spoilt = good;
  spoilt.ranges[3].distance = std::nan("");
  EXPECT_THROW(locate(spoilt, {}), InvalidArgument);
  EXPECT_THROW(locate(good, {0}), InvalidArgument);  // a pose
  EXPECT_THROW(locate(good, {99}), InvalidArgument);
  spoilt = good;
  spoilt.placed[2] = false;
  EXPECT_THROW(locate(spoilt, {}, {.start = RangeStart::file}), InvalidArgument);
  EXPECT_THROW(locate(good, {}, {.doubt = 0.9}), InvalidArgument);
}

TEST(Locate, ItCanBeStopped) {
  const auto graph = simulated_ranges<Pose2>({});
  EXPECT_THROW(locate(graph, {}, {}, {.progress = [](const Progress&) { return false; }}),
               Cancelled);
}

TEST(AttachRanges, ThePoseNearestInTime) {
  auto graph = simulated_ranges<Pose2>({.poses = 10, .ranges = 3});
  network::RangeNetwork log;
  log.names = {"0", "B", "1", "2"};
  log.landmarks = {1};
  log.ranges = {{0, 1, 4.0, 0.0, 3.4}, {2, 1, 5.0, 0.0, 3.6}, {3, 1, 6.0, 0.0, 99.0}};
  const auto attached = attach_ranges(log, graph);
  EXPECT_EQ(attached.attached, 2);
  EXPECT_EQ(attached.outside, 1);
  EXPECT_EQ(graph.names.back(), "B");
  EXPECT_EQ(graph.ranges[0].from, 3);
  EXPECT_EQ(graph.ranges[1].from, 4);
  EXPECT_EQ(graph.ranges[1].to, graph.node_count() - 1);
}

}  // namespace
}  // namespace isotherm::slam
