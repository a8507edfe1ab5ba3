#include "isotherm/network/localize/localize.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "isotherm/base/error.hpp"
#include "isotherm/geometry/points/point_alignment.hpp"
#include "isotherm/network/io/range_file.hpp"
#include "isotherm/network/simulate/simulate_network.hpp"
#include "isotherm_test/data.hpp"
#include "network/localize/networks.hpp"

namespace isotherm::network {
namespace {

using spectral::Verdict;

/// Seven points in general position.
Eigen::MatrixXd seven_points() {
  Eigen::MatrixXd points(2, 7);
  points << 0, 4, 1, 5, 8.5, 9, 12, 0, 0.5, 3, 4, 1, 5, 2.5;
  return points;
}

/// Largest error over the nodes with a position, after the best isometry if the
/// result has no anchors.
double largest_error(const LocalizeResult& result, const Eigen::MatrixXd& truth) {
  std::vector<Eigen::Index> with_position;
  for (Eigen::Index v = 0; v < truth.cols(); ++v) {
    if (result.positions.col(v).allFinite()) with_position.push_back(v);
  }
  Eigen::MatrixXd estimate = result.positions(Eigen::all, with_position);
  const Eigen::MatrixXd expected = truth(Eigen::all, with_position);
  if (!result.anchored) estimate = geometry::align_points(estimate, expected).apply(estimate);
  return (estimate - expected).colwise().norm().maxCoeff();
}

/// The points nearest to the corners of the unit square.
std::vector<Index> corners(const Eigen::MatrixXd& points) {
  std::vector<Index> nearest(4);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d corner(k % 2, k / 2);
    (points.colwise() - corner).colwise().norm().minCoeff(&nearest[k]);
  }
  return nearest;
}

class ExactNetworks : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(ExactNetworks, AreRecovered) {
  const auto [dimension, anchors] = GetParam();
  const auto simulated = simulate_network({.nodes = 120,
                                           .dimension = dimension,
                                           .anchors = anchors,
                                           .degree = dimension == 2 ? 18.0 : 40.0,
                                           .noise = 0.0,
                                           .seed = 3});
  const auto result = localize(simulated.network);
  EXPECT_EQ(result.status, LocalizeStatus::converged);
  EXPECT_EQ(result.anchored, anchors > 0);
  EXPECT_GE(result.count(NodeStatus::localised) + anchors, 110);
  EXPECT_LT(largest_error(result, simulated.truth), 1e-9);
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, ExactNetworks,
                         testing::Combine(testing::Values(2, 3), testing::Values(0, 10)));

TEST(Localize, FindsFalseAndBiasedRanges) {
  const auto simulated = simulate_network({.nodes = 150,
                                           .degree = 18.0,
                                           .noise = 0.02,
                                           .false_fraction = 0.15,
                                           .biased_fraction = 0.1,
                                           .seed = 5});
  const auto result = localize(simulated.network);
  int missed = 0;
  int wrongly_pruned = 0;
  int wrong = 0;
  for (std::size_t k = 0; k < simulated.origins.size(); ++k) {
    const auto& range = simulated.network.ranges[k];
    EXPECT_EQ(result.verdicts[k].edge, static_cast<std::int64_t>(k));
    EXPECT_EQ(result.verdicts[k].from, static_cast<std::uint64_t>(range.from));
    const bool pruned = result.verdicts[k].verdict == Verdict::prune;
    const bool bad = simulated.origins[k] != RangeOrigin::measured;
    wrong += bad ? 1 : 0;
    missed += bad && !pruned ? 1 : 0;
    wrongly_pruned += !bad && pruned ? 1 : 0;
  }
  EXPECT_LT(missed, 0.05 * wrong);
  EXPECT_LT(wrongly_pruned, 0.02 * static_cast<double>(simulated.origins.size()));
  EXPECT_LT(largest_error(result, simulated.truth), 0.1 * simulated.radius);
}

TEST(Localize, FalseRangesHardlyMoveTheNodes) {
  const auto simulated =
      simulate_network({.nodes = 100, .degree = 20.0, .false_fraction = 0.2, .seed = 1});
  auto only_true = simulated.network;
  only_true.ranges.clear();
  for (std::size_t k = 0; k < simulated.origins.size(); ++k) {
    if (simulated.origins[k] != RangeOrigin::measured) continue;
    only_true.ranges.push_back(simulated.network.ranges[k]);
  }
  const auto result = localize(simulated.network);
  const auto best = localize(only_true);
  double ours = 0.0;
  double theirs = 0.0;
  int common = 0;
  for (Index v = 0; v < simulated.network.node_count(); ++v) {
    if (result.nodes[v] != NodeStatus::localised) continue;
    const double error = (result.positions.col(v) - simulated.truth.col(v)).norm();
    EXPECT_LT(error, 0.5 * simulated.radius) << v;
    if (best.nodes[v] != NodeStatus::localised) continue;
    ours += error * error;
    theirs += (best.positions.col(v) - simulated.truth.col(v)).squaredNorm();
    ++common;
  }
  EXPECT_GE(common, 80);
  EXPECT_LT(std::sqrt(ours), 1.5 * std::sqrt(theirs));
}

TEST(Localize, RangesThatAreTooLongLeaveMostNodesOfASparseNetwork) {
  const auto simulated = simulate_network(
      {.nodes = 200, .degree = 13.0, .noise = 0.03, .biased_fraction = 0.2, .seed = 4});
  const auto result = localize(simulated.network);
  EXPECT_GE(result.count(NodeStatus::localised), 100);
  EXPECT_LT(largest_error(result, simulated.truth), 0.5 * simulated.radius);
}

TEST(Localize, ExactRangesAndNoisyOnesHaveNoiseOfTheirOwn) {
  auto simulated = simulate_network({.nodes = 60, .degree = 25.0, .noise = 0.05, .seed = 2});
  for (std::size_t k = 0; k < simulated.network.ranges.size(); k += 5) {
    auto& range = simulated.network.ranges[k];
    range.distance = (simulated.truth.col(range.from) - simulated.truth.col(range.to)).norm();
    range.variance = 0.0;
  }
  const auto result = localize(simulated.network);
  EXPECT_GE(result.count(NodeStatus::localised), 35);
  EXPECT_LT(result.sigma, 0.01 * simulated.radius);
  EXPECT_NEAR(result.noise_factor, 1.0, 0.3);
  EXPECT_LT(largest_error(result, simulated.truth), 0.2 * simulated.radius);
}

TEST(Localize, WhatHangsOnTwoNodesIsMirrored) {
  // Two complete graphs of five nodes share nodes 3 and 4; the anchors are in the first.
  Eigen::MatrixXd truth(2, 8);
  truth << 0, 4, 1, 5, 8.5, 9, 12, 7, 0, 0.5, 3, 4, 1, 5, 2.5, 7;
  auto pairs = all_pairs({0, 1, 2, 3, 4});
  const auto other = all_pairs({3, 4, 5, 6, 7});
  pairs.insert(pairs.end(), other.begin() + 1, other.end());
  const auto result = localize(exact_network(truth, pairs, {0, 1, 2}));
  for (const int v : {3, 4}) EXPECT_EQ(result.nodes[v], NodeStatus::localised) << v;
  for (const int v : {5, 6, 7}) EXPECT_EQ(result.nodes[v], NodeStatus::mirrored) << v;
  EXPECT_LT(largest_error(result, truth), 1e-6);
}

TEST(Localize, RepeatsOfARangeCountOnce) {
  const auto once = simulate_network({.nodes = 40, .degree = 25.0, .seed = 3}).network;
  auto often = once;
  for (int k = 0; k < 3; ++k) {
    often.ranges.insert(often.ranges.end(), once.ranges.begin(), once.ranges.end());
  }
  const auto expected = localize(once);
  const auto merged = localize(often);
  const auto apart = localize(often, {.merge_repeats = false});
  ASSERT_EQ(merged.nodes, expected.nodes);
  EXPECT_EQ(merged.verdicts.size(), often.ranges.size());
  for (Index v = 0; v < once.node_count(); ++v) {
    if (expected.nodes[v] != NodeStatus::localised) continue;
    EXPECT_EQ(merged.positions.col(v), expected.positions.col(v));
    EXPECT_EQ(merged.covariances[v], expected.covariances[v]);
    if (apart.nodes[v] != NodeStatus::localised) continue;
    EXPECT_LT(apart.covariances[v].trace(), expected.covariances[v].trace());
  }
}

TEST(Localize, ResultsDoNotDependOnTheThreads) {
  const auto simulated = simulate_network({.nodes = 80, .false_fraction = 0.1, .seed = 2});
  const auto one = localize(simulated.network, {.threads = 1});
  const auto two = localize(simulated.network, {.threads = 2});
  EXPECT_EQ(one.nodes, two.nodes);
  for (Index v = 0; v < simulated.network.node_count(); ++v) {
    if (one.nodes[v] == NodeStatus::localised) {
      EXPECT_EQ(one.positions.col(v), two.positions.col(v));
    }
  }
}

TEST(Localize, CovariancesMatchTheErrors) {
  // Normalised squared errors average 1 a coordinate.
  double sum = 0.0;
  int terms = 0;
  for (const std::int64_t anchors : {0, 8}) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const auto simulated = simulate_network(
          {.nodes = 60, .anchors = anchors, .degree = 25.0, .noise = 0.01, .seed = seed});
      const auto result = localize(simulated.network);
      std::vector<Index> nodes;
      for (Index v = 0; v < simulated.network.node_count(); ++v) {
        if (result.nodes[v] == NodeStatus::localised) nodes.push_back(v);
      }
      Eigen::MatrixXd estimate = result.positions(Eigen::all, nodes);
      const Eigen::MatrixXd truth = simulated.truth(Eigen::all, nodes);
      if (anchors == 0) estimate = geometry::align_points(estimate, truth).apply(estimate);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const Eigen::Vector2d error = estimate.col(k) - truth.col(k);
        sum += error.dot(result.covariances[nodes[k]].ldlt().solve(error));
        terms += 2;
      }
    }
  }
  EXPECT_NEAR(sum / terms, 1.0, 0.15);
}

TEST(Localize, AChainIsNotRigid) {
  const auto truth = seven_points();
  const auto result = localize(exact_network(truth, {{0, 1}, {1, 2}, {2, 3}, {3, 4}}, {0, 1, 2}));
  EXPECT_EQ(result.status, LocalizeStatus::no_start);
  EXPECT_EQ(result.nodes[3], NodeStatus::not_rigid);
  EXPECT_EQ(result.nodes[4], NodeStatus::not_rigid);
  EXPECT_EQ(result.nodes[5], NodeStatus::not_connected);
  EXPECT_TRUE(std::isnan(result.positions(0, 3)));
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
}

TEST(Localize, WhatHangsOnAHingeIsNotRigid) {
  // Two complete graphs of four nodes share node 3.
  auto pairs = all_pairs({0, 1, 2, 3});
  const auto other = all_pairs({3, 4, 5, 6});
  pairs.insert(pairs.end(), other.begin(), other.end());
  const auto truth = seven_points();
  const auto result = localize(exact_network(truth, pairs, {0, 1, 2}));
  EXPECT_EQ(result.nodes[3], NodeStatus::localised);
  for (const int v : {4, 5, 6}) EXPECT_EQ(result.nodes[v], NodeStatus::not_rigid) << v;
  EXPECT_LT((result.positions.col(3) - truth.col(3)).norm(), 1e-9);
}

TEST(Localize, TwoRangesLeaveAMirrorImage) {
  const auto truth = seven_points();
  auto pairs = all_pairs({0, 1, 2, 3});
  pairs.emplace_back(0, 4);
  pairs.emplace_back(1, 4);
  const auto result = localize(exact_network(truth, pairs, {0, 1, 2}));
  EXPECT_EQ(result.nodes[3], NodeStatus::localised);
  EXPECT_EQ(result.nodes[4], NodeStatus::mirrored);
  EXPECT_TRUE(std::isnan(result.positions(0, 4)));
}

TEST(Localize, AnchorsOnALineLeaveAMirrorImage) {
  auto truth = seven_points();
  truth.row(1).head(3).setZero();
  const auto result = localize(exact_network(truth, all_pairs({0, 1, 2, 3, 4, 5, 6}), {0, 1, 2}));
  EXPECT_EQ(result.count(NodeStatus::localised), 0);
  for (int v = 3; v < 7; ++v) EXPECT_EQ(result.nodes[v], NodeStatus::mirrored) << v;
}

TEST(Localize, AnIsolatedNodeIsNotConnected) {
  const auto truth = seven_points();
  for (const auto& anchors : {std::vector<Index>{}, std::vector<Index>{0, 1, 2}}) {
    const auto result = localize(exact_network(truth, all_pairs({0, 1, 2, 3, 4, 5}), anchors));
    EXPECT_EQ(result.nodes[6], NodeStatus::not_connected);
    EXPECT_LT(largest_error(result, truth), 1e-9);
  }
}

TEST(Localize, FalseRangesDoNotConnectANode) {
  // Four ranges to nodes that have no neighbour in common, with any lengths.
  auto simulated = simulate_network({.nodes = 200, .degree = 16.0, .noise = 0.02, .seed = 5});
  auto& network = simulated.network;
  auto& ranges = network.ranges;
  const Index stray = ranges.front().from;
  std::erase_if(ranges,
                [&](const auto& range) { return range.from == stray || range.to == stray; });
  const double variance = ranges.front().variance;
  for (const Index other : corners(simulated.truth))
    ranges.push_back({stray, other, 0.1, variance});
  const auto result = localize(network);
  EXPECT_EQ(result.nodes[stray], NodeStatus::not_connected);
  for (std::size_t k = ranges.size() - 4; k < ranges.size(); ++k) {
    EXPECT_EQ(result.verdicts[k].verdict, Verdict::prune);
  }
  // No range of another node is.
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 4);
  EXPECT_GE(result.count(NodeStatus::localised), 180);
}

TEST(Localize, ASimplexIsUniqueButUnchecked) {
  const auto truth = seven_points();
  const auto network = exact_network(truth.leftCols(3), all_pairs({0, 1, 2}));
  const auto result = localize(network);
  EXPECT_EQ(result.count(NodeStatus::localised), 3);
  EXPECT_LT(largest_error(result, truth.leftCols(3)), 1e-9);
  EXPECT_EQ(count(result.verdicts, Verdict::ambiguous), 3);
}

TEST(Localize, OfRepeatedRangesThatDisagreeTheOnesThatFitAreKept) {
  const auto truth = seven_points();
  auto network = exact_network(truth, all_pairs({0, 1, 2, 3, 4, 5, 6}));
  for (auto& range : network.ranges) range.variance = 1e-4;
  auto repeated = network.ranges[4];
  network.ranges.push_back(repeated);
  repeated.distance += 2.0;
  network.ranges.push_back(repeated);
  const auto result = localize(network, {.estimate_noise = false});
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 1);
  EXPECT_EQ(result.verdicts.back().verdict, Verdict::prune);
  EXPECT_GT(result.verdicts.back().score, result.verdicts.back().threshold);
  EXPECT_LT(largest_error(result, truth), 1e-6);
}

TEST(Localize, EmptyAndTinyNetworks) {
  EXPECT_EQ(localize(RangeNetwork{}).status, LocalizeStatus::no_start);
  const auto truth = seven_points();
  const auto pair = localize(exact_network(truth.leftCols(2), {{0, 1}}));
  EXPECT_EQ(pair.nodes.size(), 2u);
  const auto anchors = localize(exact_network(truth.leftCols(2), {{0, 1}}, {0, 1}));
  EXPECT_EQ(anchors.count(NodeStatus::anchor), 2);
}

TEST(Localize, RejectsBadNetworks) {
  const auto good = exact_network(seven_points(), all_pairs({0, 1, 2, 3}));
  const auto message_for = [&](auto spoil) {
    auto network = good;
    spoil(network);
    try {
      localize(network);
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  using testing::HasSubstr;
  EXPECT_THAT(message_for([](auto& n) { n.ranges[2].distance = -1.0; }), HasSubstr("ranges[2]"));
  EXPECT_THAT(message_for([&](auto& n) { n.ranges[2].distance = kNan; }), HasSubstr("ranges[2]"));
  EXPECT_THAT(message_for([&](auto& n) { n.ranges[1].variance = kNan; }), HasSubstr("ranges[1]"));
  EXPECT_THAT(message_for([](auto& n) { n.ranges[1].to = 99; }), HasSubstr("ranges[1]"));
  EXPECT_THAT(message_for([](auto& n) { n.ranges[1].to = n.ranges[1].from; }),
              HasSubstr("to itself"));
  EXPECT_THAT(message_for([](auto& n) { n.landmarks = {99}; }), HasSubstr("landmarks"));
  EXPECT_THROW(localize(good, {.significance = 0.0}), InvalidArgument);
  EXPECT_THROW(localize(good, {.patch_size = 2}), InvalidArgument);
}

// A few beacons among hundreds of known places, of which each hears one.
TEST(Localize, FindsBeaconsHeardByARobot) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "snl/plaza1/plaza1.pyfg");
  auto network = read_ranges(path.string()).network;
  const auto truth = network.positions;
  const auto beacons = network.landmarks;
  network.landmarks.clear();
  constexpr std::size_t kStride = 4;  // for a short test
  std::vector<RangeMeasurement> some;
  for (std::size_t k = 0; k < network.ranges.size(); k += kStride) {
    some.push_back(network.ranges[k]);
    network.landmarks.push_back(some.back().from);
  }
  network.ranges = std::move(some);
  const auto result = localize(network);
  ASSERT_EQ(beacons.size(), 4u);
  for (const Index v : beacons) {
    EXPECT_EQ(result.nodes[v], NodeStatus::localised);
    EXPECT_LT((result.positions.col(v) - truth.col(v)).norm(), 0.2);  // metres
  }
}

TEST(Localize, CanBeCancelled) {
  const auto simulated = simulate_network({.nodes = 100});
  LocalizeOptions options;
  options.progress = [](const Progress&) { return false; };
  EXPECT_THROW(localize(simulated.network, options), Cancelled);
}

// Rigid, and every node in one place by its neighbours, but it bends within the noise.
TEST(Localize, WhatOneRangeWouldTellAsWellHasNoPlace) {
  constexpr int kRungs = 60;
  Eigen::MatrixXd truth(2, 2 * kRungs);
  for (int k = 0; k < 2 * kRungs; ++k) truth.col(k) << k / 2, k % 2;
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < truth.cols(); ++a) {
    for (int b = a + 1; b < std::min<int>(a + 6, 2 * kRungs); ++b) pairs.emplace_back(a, b);
  }
  auto network = exact_network(truth, pairs, {0, 1, 2, 3});
  for (auto& range : network.ranges) range.variance = 0.0025;
  const auto result = localize(network, {.estimate_noise = false});
  EXPECT_EQ(result.nodes[8], NodeStatus::localised);
  EXPECT_EQ(result.nodes.back(), NodeStatus::not_rigid);
  for (std::size_t v = 4; v < result.nodes.size(); ++v) {
    if (result.nodes[v] != NodeStatus::localised) continue;
    EXPECT_LT(std::sqrt(result.covariances[v].trace()), 1.5);
  }
}

}  // namespace
}  // namespace isotherm::network
