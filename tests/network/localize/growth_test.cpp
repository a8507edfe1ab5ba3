#include <gtest/gtest.h>

#include "isotherm/geometry/points/point_alignment.hpp"
#include "isotherm/network/simulate/simulate_network.hpp"
#include "localize/evidence/agreement.hpp"
#include "localize/grow/grow.hpp"
#include "localize/patches/seeds.hpp"
#include "localize/problem/repeats.hpp"
#include "localize/start/anchor_frame.hpp"
#include "network/localize/networks.hpp"
#include "network/localize/range_problems.hpp"

namespace isotherm::network::detail {
namespace {

const Evidence kNoEvidence = {{}, {kGate, kGate}};

Eigen::MatrixXd six_points() {
  Eigen::MatrixXd points(2, 6);
  points << 0, 4, 1, 5, 8.5, 3, 0, 0.5, 3, 4, 1, 6;
  return points;
}

TEST(Seeds, ACliqueLeavesOutTheNodeWithFalseRanges) {
  auto network = exact_network(six_points(), all_pairs({0, 1, 2, 3, 4, 5}));
  for (auto& range : network.ranges) {
    range.variance = 0.01;
    if (range.to == 5 && range.from < 3) range.distance += 3.0;
  }
  const auto problem = make_problem(network);
  const auto cliques = consistent_cliques(problem, all_of(problem), kGate, {});
  ASSERT_FALSE(cliques.empty());
  EXPECT_EQ(cliques.front().members, (std::vector<Index>{0, 1, 2, 3, 4}));
  const Eigen::MatrixXd truth = six_points().leftCols(5);
  const auto& map = cliques.front().positions;
  EXPECT_LT((geometry::align_points(map, truth).apply(map) - truth).norm(), 0.1);  // one sigma
}

TEST(Seeds, PointsOnALineAreNone) {
  auto points = six_points();
  points.row(1).setZero();
  const auto problem = make_problem(exact_network(points, all_pairs({0, 1, 2, 3, 4, 5})));
  EXPECT_TRUE(consistent_cliques(problem, all_of(problem), kGate, {}).empty());
}

TEST(Grow, FromACliqueReachesAllNodes) {
  const auto simulated = simulate_network({.nodes = 120,
                                           .anchors = 0,
                                           .degree = 20.0,
                                           .noise = 0.02,
                                           .false_fraction = 0.2,
                                           .seed = 7});
  const auto problem = make_problem(simulated.network);
  const auto trusted = all_of(problem);
  const auto seeds = consistent_cliques(problem, trusted, kGate, {});
  ASSERT_FALSE(seeds.empty());
  auto map = place_nodes(problem, seeds.front().members, seeds.front().positions);
  grow(problem, trusted, kGate, kNoEvidence, {}, map);
  EXPECT_GE(placed_count(map), 110);
  std::vector<Index> nodes;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (map.placed[v]) nodes.push_back(v);
  }
  const Eigen::MatrixXd found = map.positions(Eigen::all, nodes);
  const Eigen::MatrixXd truth = simulated.truth(Eigen::all, nodes);
  const Eigen::MatrixXd aligned = geometry::align_points(found, truth).apply(found);
  EXPECT_LT((aligned - truth).colwise().norm().maxCoeff(), 0.2 * simulated.radius);
}

TEST(Grow, StopsAtTheLimitAndWhereNothingIsPlaced) {
  const auto simulated = simulate_network({.nodes = 80, .anchors = 0, .degree = 20.0, .seed = 1});
  const auto problem = make_problem(simulated.network);
  const auto trusted = all_of(problem);
  auto none = place_nodes(problem, {}, Eigen::MatrixXd(2, 0));
  grow(problem, trusted, kGate, kNoEvidence, {}, none);
  EXPECT_EQ(placed_count(none), 0);
  const auto seeds = consistent_cliques(problem, trusted, kGate, {});
  auto map = place_nodes(problem, seeds.front().members, seeds.front().positions);
  grow(problem, trusted, kGate, kNoEvidence, {}, map, placed_count(map));
  EXPECT_EQ(placed_count(map), static_cast<Index>(seeds.front().members.size()));
}

TEST(Agreement, CountsWhatThePairsExplainBeyondTheCoordinates) {
  auto network = exact_network(six_points(), all_pairs({0, 1, 2, 3, 4, 5}));
  for (auto& range : network.ranges) range.variance = 1.0;
  network.ranges[0].distance += 100.0;
  const auto problem = make_problem(network);
  const auto truth = place_nodes(problem, {0, 1, 2, 3, 4, 5}, six_points());
  const auto found = agreement(problem, all_of(problem), kGate, truth);
  EXPECT_EQ(found.pairs, 15);
  EXPECT_NEAR(found.cost, kGate, 1e-9);
  EXPECT_NEAR(found.credit, (15 - 12 - 1) * kGate, 1e-9);
}

TEST(AnchorFrame, IsThatOfTheSideOfAFoldWithMoreAnchors) {
  const auto points = six_points();
  auto network = exact_network(points, all_pairs({0, 1, 2, 3, 4, 5}), {0, 1, 2, 3, 4, 5});
  const auto problem = make_problem(network);
  const auto anchors = anchors_only(network, problem);
  auto part = anchors;
  part.positions.row(0).array() += 20.0;
  part.positions.col(4).array() += 50.0;
  ASSERT_TRUE(align_to_anchors(problem, anchors, part));
  EXPECT_LT((part.positions.leftCols(4) - points.leftCols(4)).norm(), 1e-9);
  part.placed.assign(6, false);
  EXPECT_FALSE(align_to_anchors(problem, anchors, part));
}

TEST(Repeats, BecomeTheirMedian) {
  auto network = exact_network(six_points(), {{0, 1}, {1, 2}, {1, 0}, {0, 1}, {1, 0}});
  const std::vector<double> distances = {5.0, 7.0, 5.1, 9.0, 4.9};
  for (std::size_t k = 0; k < distances.size(); ++k) network.ranges[k].distance = distances[k];
  const auto merged = merge_repeats(network);
  ASSERT_EQ(merged.network.ranges.size(), 2u);
  EXPECT_DOUBLE_EQ(merged.network.ranges[0].distance, 5.0);
  EXPECT_DOUBLE_EQ(merged.network.ranges[1].distance, 7.0);
  EXPECT_EQ(merged.pair_of, (std::vector<Index>{0, 1, 0, 0, 0}));
  spectral::EdgeVerdicts pairs(2);
  const auto verdicts = verdicts_on_repeats(network, merged, pairs, {0.1, 0.1}, kGate);
  ASSERT_EQ(verdicts.size(), 5u);
  for (const std::size_t k : {0u, 1u, 2u, 4u}) {
    EXPECT_EQ(verdicts[k].verdict, pairs[0].verdict) << k;
    EXPECT_EQ(verdicts[k].edge, static_cast<std::int64_t>(k));
  }
  EXPECT_EQ(verdicts[3].verdict, spectral::Verdict::prune);
  EXPECT_EQ(verdicts[3].stage, "repeats");
}

}  // namespace
}  // namespace isotherm::network::detail
