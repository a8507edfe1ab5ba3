#include "localize/evidence/evidence.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "isotherm/network/simulate/simulate_network.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/star.hpp"
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

TEST(Absence, ItsSlopeIsTheDerivativeOfItsCost) {
  const auto points = random_points(400, 1);
  const auto problem = make_problem(disc_network(points, 0.1, 0.9));
  const auto absence = Absence::learn(problem, all_of(problem), at(problem, points));
  constexpr double kStep = 1e-7;
  for (double distance = 0.0013; distance < 0.2; distance += 0.0031) {
    const double rise = absence.cost(distance + kStep) - absence.cost(distance - kStep);
    EXPECT_NEAR(absence.slope(distance), rise / (2.0 * kStep), 1e-4) << distance;
  }
}

TEST(Absence, SaysNothingWhereFewHaveARange) {
  const auto points = random_points(400, 2);
  const auto problem = make_problem(disc_network(points, 0.15, 0.3));
  const auto absence = Absence::learn(problem, all_of(problem), at(problem, points));
  EXPECT_EQ(absence.reach(), 0.0);
  EXPECT_EQ(absence.cost(0.05), 0.0);
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

TEST(RangeCost, IsThatOfTheLikeliestKind) {
  const Evidence evidence = {{.share = {0.7, 0.2, 0.1}, .excess = 0.5, .longest = 4.0}, {}};
  constexpr double kSigma = 0.1;
  const auto cost = evidence.cost_of(kSigma);
  const double peak = 0.7 / (kSigma * std::sqrt(2.0 * M_PI));
  for (double residual = -30.0; residual <= 30.0; residual += 0.37) {
    const double normal = peak * std::exp(-0.5 * residual * residual);
    const double excess = -residual * kSigma;
    const double too_long = excess < 0.0 ? 0.0 : 0.2 / 0.5 * std::exp(-excess / 0.5);
    const double density = std::max({normal, too_long, 0.1 / 4.0});
    EXPECT_NEAR(cost(residual), 2.0 * std::log(peak / density), 1e-9) << residual;
  }
}

TEST(RangeCost, SaysHowFarOffARangeMayBe) {
  const Evidence evidence = {{.share = {0.7, 0.2, 0.1}, .excess = 0.5, .longest = 4.0}, {}};
  const auto cost = evidence.cost_of(0.1);
  for (const double most : {0.5, 2.0, 0.5 * (cost.too_long + cost.anything)}) {
    EXPECT_NEAR(cost(cost.apart_at(most)), most, 1e-9);
    EXPECT_NEAR(cost(-cost.close_at(most)), most, 1e-9);
  }
  EXPECT_TRUE(std::isinf(cost.apart_at(cost.anything)));
  EXPECT_TRUE(std::isinf(cost.close_at(cost.anything)));
}

TEST(Evidence, KnowsTheKindsOfRange) {
  auto simulated =
      simulate_network({.nodes = 300, .degree = 15.0, .biased_fraction = 0.2, .seed = 5});
  const auto biased = make_problem(simulated.network);
  const auto long_ones =
      learn_evidence({biased, all_of(biased), kGate, {}}, at(biased, simulated.truth));
  EXPECT_NEAR(long_ones.model.share[kTooLong], 0.2, 0.05);

  simulated = simulate_network({.nodes = 300, .degree = 15.0, .false_fraction = 0.2, .seed = 5});
  const auto other = make_problem(simulated.network);
  const auto false_ones =
      learn_evidence({other, all_of(other), kGate, {}}, at(other, simulated.truth));
  EXPECT_NEAR(false_ones.model.share[kAnything], 0.2, 0.05);
  EXPECT_LT(false_ones.model.share[kTooLong], 0.05);
}

TEST(Worth, IsHighestAtTheTruth) {
  const auto simulated =
      simulate_network({.nodes = 200, .degree = 15.0, .false_fraction = 0.2, .seed = 7});
  const auto problem = make_problem(simulated.network);
  const auto trusted = all_of(problem);
  const LocalizeOptions options;
  const MapTask task{problem, trusted, kGate, options};
  const double best = worth(task, at(problem, simulated.truth));
  auto moved = at(problem, simulated.truth);
  Index most = 0;  // the node with the most ranges
  for (Index v = 0; v < problem.nodes; ++v) {
    if (problem.pair_graph.neighbours(v).size() > problem.pair_graph.neighbours(most).size())
      most = v;
  }
  moved.positions.col(most).x() += simulated.radius;
  EXPECT_LT(worth(task, moved), best);
  moved.placed[most] = false;
  EXPECT_LT(worth(task, moved), best);
  // Rigid motions leave it as it is, but for the box around the nodes.
  auto turned = at(problem, simulated.truth);
  turned.positions = (turned.positions.colwise() + Eigen::Vector2d(3.0, -1.0)).eval();
  EXPECT_NEAR(worth(task, turned), best, 1e-6 * std::abs(best));
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
  const Evidence evidence = {{.share = {0.9, 0.0, 0.1}}, absence};
  auto place = star(problem, evidence, placement, 3);
  const auto blind = multilaterate(place);
  ASSERT_TRUE(blind);
  EXPECT_NEAR(blind->rival_cost - blind->cost, 0.0, 1e-9);
  crowd.add_strangers(place, 3, placement.placed);
  const auto found = multilaterate(place);
  ASSERT_TRUE(found);
  EXPECT_GT(found->rival_cost - found->cost, 3.0);
  EXPECT_LT((found->position - points.col(3)).norm(), 1e-6);
}

}  // namespace
}  // namespace isotherm::network::detail
