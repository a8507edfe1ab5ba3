#include "localize/evidence/evidence.hpp"

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "isotherm/network/simulate/simulate_network.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/multilateration.hpp"
#include "localize/evidence/star.hpp"
#include "localize/firm/hinge_parts.hpp"
#include "network/localize/networks.hpp"
#include "network/localize/range_problems.hpp"

namespace isotherm::network::detail {
namespace {

std::vector<Index> numbers(Index count) {
  std::vector<Index> nodes;
  for (Index v = 0; v < count; ++v) nodes.push_back(v);
  return nodes;
}

Placement at(const RangeProblem& problem, const Eigen::MatrixXd& positions) {
  return place_nodes(problem, numbers(problem.nodes), positions);
}

Eigen::MatrixXd random_points(int count, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd points(2, count);
  for (auto& value : points.reshaped()) value = random.uniform();
  return points;
}

/// Pairs nearer than a radius, each with a probability.
RangeNetwork disc_network(const Eigen::MatrixXd& points, double radius, double chance) {
  Random random(9);
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < points.cols(); ++a) {
    for (int b = a + 1; b < points.cols(); ++b) {
      const bool near = (points.col(a) - points.col(b)).norm() <= radius;
      if (near && random.uniform() <= chance) pairs.emplace_back(a, b);
    }
  }
  return exact_network(points, pairs);
}

TEST(Absence, CostsWithinTheRadiusOfADiscAndNotBeyond) {
  const auto points = random_points(400, 1);
  const auto problem = make_problem(disc_network(points, 0.1, 1.0));
  const auto absence = Absence::learn(problem, all_of(problem), at(problem, points));
  for (const double distance : {0.03, 0.05, 0.08}) EXPECT_GT(absence.cost(distance), 4.0);
  for (const double distance : {0.12, 0.2, 5.0}) EXPECT_EQ(absence.cost(distance), 0.0);
  EXPECT_NEAR(absence.reach(), 0.1, 0.015);
}

TEST(Absence, SaysNothingWhereFewHaveARange) {
  const auto points = random_points(400, 2);
  const auto problem = make_problem(disc_network(points, 0.15, 0.3));
  const auto absence = Absence::learn(problem, all_of(problem), at(problem, points));
  EXPECT_EQ(absence.reach(), 0.0);
  EXPECT_EQ(absence.cost(0.05), 0.0);
}

TEST(Absence, IsLearnedFromLocalMapsToo) {
  const auto points = random_points(300, 3);
  const auto problem = make_problem(disc_network(points, 0.12, 1.0));
  const auto patches = make_patches(problem, all_of(problem), {});
  const auto absence = Absence::learn(problem, all_of(problem), patches);
  EXPECT_GT(absence.cost(0.06), 4.0);
  EXPECT_EQ(absence.cost(0.15), 0.0);
}

TEST(Absence, OfNothingIsNothing) {
  const auto problem = make_problem(exact_network(Eigen::MatrixXd(2, 0), {}));
  EXPECT_EQ(Absence::learn(problem, {}, at(problem, Eigen::MatrixXd(2, 0))).reach(), 0.0);
  EXPECT_EQ(Absence().cost(0.0), 0.0);
  // Ranges of length 0.
  const Eigen::MatrixXd same = Eigen::MatrixXd::Zero(2, 4);
  const auto heap = make_problem(exact_network(same, all_pairs({0, 1, 2, 3})));
  EXPECT_EQ(Absence::learn(heap, all_of(heap), at(heap, same)).reach(), 0.0);
}

TEST(Evidence, KnowsOnWhichSideRangesErr) {
  auto simulated =
      simulate_network({.nodes = 300, .degree = 15.0, .biased_fraction = 0.2, .seed = 5});
  const auto problem = make_problem(simulated.network);
  const auto long_ones =
      learn_evidence(problem, all_of(problem), kGate, at(problem, simulated.truth));
  EXPECT_GT(long_ones.limits.apart, long_ones.limits.close + 5.0);
  const auto patches = make_patches(problem, all_of(problem), {});
  const auto local = learn_evidence(problem, all_of(problem), kGate, patches);
  EXPECT_GT(local.limits.apart, local.limits.close + 3.0);

  simulated = simulate_network({.nodes = 300, .degree = 15.0, .false_fraction = 0.2, .seed = 5});
  const auto other = make_problem(simulated.network);
  const auto short_ones = learn_evidence(other, all_of(other), kGate, at(other, simulated.truth));
  EXPECT_LT(short_ones.limits.apart, short_ones.limits.close);
}

TEST(Crowd, CostsWhatAllPairsCost) {
  const auto points = random_points(300, 4);
  const auto problem = make_problem(disc_network(points, 0.1, 1.0));
  const auto absence = Absence::learn(problem, all_of(problem), at(problem, points));
  // Somewhere else, so that there are pairs without ranges.
  const auto elsewhere = random_points(300, 6);
  double expected = 0.0;
  for (Index a = 0; a < 300; ++a) {
    for (Index b = a + 1; b < 300; ++b) {
      const double distance = (elsewhere.col(a) - elsewhere.col(b)).norm();
      if (!has_range(problem, a, b)) expected += absence.cost(distance);
    }
  }
  ASSERT_GT(expected, 1.0);
  EXPECT_NEAR(absence_cost(problem, absence, at(problem, elsewhere)), expected, 1e-9 * expected);
}

TEST(Crowd, DecidesBetweenTwoPlacesOfANode) {
  // A node with ranges to two others at x = 0 and x = 1, above or below the line. Above
  // there is another node, to which it would have a range.
  Eigen::MatrixXd points = random_points(200, 7);
  points.col(0) << 3.0, 0.0;
  points.col(1) << 3.1, 0.0;
  points.col(2) << 3.05, 0.1;
  points.col(3) << 3.05, -0.06;
  auto network = disc_network(points, 0.1, 1.0);
  std::erase_if(network.ranges, [](const auto& range) {
    return std::min(range.from, range.to) == 2 || std::max(range.from, range.to) == 2;
  });
  const auto problem = make_problem(network);
  auto placement = at(problem, points);
  placement.placed[3] = false;
  const auto absence = Absence::learn(problem, all_of(problem), placement);
  const Crowd crowd(problem, placement, absence);
  auto place = star(problem, placement, 3);
  const auto blind = multilaterate(place, {kGate, kGate});
  ASSERT_TRUE(blind);
  EXPECT_NEAR(blind->rival_cost - blind->cost, 0.0, 1e-9);
  crowd.add_strangers(place, 3, placement.placed);
  const auto found = multilaterate(place, {kGate, kGate});
  ASSERT_TRUE(found);
  EXPECT_GT(found->rival_cost - found->cost, 3.0);
  EXPECT_LT((found->position - points.col(3)).norm(), 1e-6);
}

TEST(HingeParts, AreWhatHangsOnANeighbourhood) {
  // A chain of triangles: without a node in the middle and its neighbours it falls in two.
  constexpr int kNodes = 13;
  std::vector<std::pair<int, int>> pairs;
  for (int v = 0; v + 1 < kNodes; ++v) pairs.emplace_back(v, v + 1);
  for (int v = 0; v + 2 < kNodes; ++v) pairs.emplace_back(v, v + 2);
  const auto problem = make_problem(exact_network(random_points(kNodes, 8), pairs));
  std::vector<bool> placed(kNodes, true);
  const auto parts = parts_behind(problem, all_of(problem), placed, 6);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].size() + parts[1].size(), 8u);
  EXPECT_TRUE(parts[0] == (std::vector<Index>{0, 1, 2, 3}) ||
              parts[1] == (std::vector<Index>{0, 1, 2, 3}));
  placed[3] = placed[2] = placed[1] = false;
  EXPECT_EQ(parts_behind(problem, all_of(problem), placed, 6).size(), 1u);
  EXPECT_TRUE(parts_behind(problem, std::vector<bool>(pairs.size(), false), placed, 6).empty());
}

}  // namespace
}  // namespace isotherm::network::detail
