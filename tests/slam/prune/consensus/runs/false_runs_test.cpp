#include "prune/consensus/runs/false_runs.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "prune/consensus/constants.hpp"
#include "prune/consensus/log_sum.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;

Runs<Pose2> some_runs(Index loops) {
  Random random(12);
  const auto made = random_loop_graph<Pose2>(random, 30, loops, 1.0);
  return {reduce(made.graph, edge_roles(made.graph)), 20};
}

// log of the integral over the share c of its density (1 - c)^(n - 1) n, n = kFalseAlone, times the
// product of 1 - c + c exp(log_led), by the midpoint rule.
double exact_evidence(const std::vector<double>& log_led) {
  constexpr int kParts = 20000;
  double sum = -1e300;
  for (int part = 0; part < kParts; ++part) {
    const double share = (part + 0.5) / kParts;
    double log_product = std::log(kFalseAlone / kParts) + (kFalseAlone - 1.0) * std::log1p(-share);
    for (const double led : log_led) {
      log_product += log_sum(std::log1p(-share), std::log(share) + led);
    }
    sum = log_sum(sum, log_product);
  }
  return sum;
}

// Where it is plain which of them follow the bound is exact.
TEST(FalseRuns, IntegrateOutHowManyFollow) {
  const auto runs = some_runs(40);
  Random random(5);
  const std::vector<bool> accepted(40, false);
  for (const double plain : {0.0, 5.0, 30.0}) {
    std::vector<double> all(40);
    std::vector<double> led;
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k] = random.normal() + (k % 3 == 0 ? plain : -plain);
      if (runs.leader(static_cast<Index>(k)) != Runs<Pose2>::kNone) led.push_back(all[k]);
    }
    ASSERT_GT(led.size(), 20U);
    const auto found = false_runs(runs, accepted, all);
    const double exact = exact_evidence(led);
    EXPECT_LE(found.log_evidence, exact + 1e-6) << plain;
    EXPECT_NEAR(found.log_evidence, exact, plain > 20.0 ? 1e-3 : 3.0) << plain;
  }
}

// One that the one before leads is so where that agrees, and by chance where it does not.
TEST(FalseRuns, FollowOnlyFalseOnesThatAreAlike) {
  const auto runs = some_runs(40);
  std::vector<bool> accepted(40, false);
  for (std::size_t k = 0; k < 20; ++k) accepted[k] = true;
  std::vector<double> log_led(40, 50.0);
  log_led[39] = -50.0;
  const auto found = false_runs(runs, accepted, log_led);
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    const Index before = runs.leader(static_cast<Index>(k));
    const bool follows = before != Runs<Pose2>::kNone && !accepted[k] && !accepted[before];
    if (!follows) {
      EXPECT_EQ(found.log_follows[k], 0.0) << k;
    } else if (k == 39) {
      EXPECT_LT(found.log_follows[k], 0.0);
    } else {
      EXPECT_GT(found.log_follows[k], 40.0) << k;
      EXPECT_LT(found.log_follows[k], 50.0) << k;
    }
  }
}

TEST(FalseRuns, OfNoLoopsSayNothing) {
  const auto none = false_runs(some_runs(0), {}, {});
  EXPECT_TRUE(none.log_follows.empty());
  EXPECT_NEAR(none.log_evidence, 0.0, 1e-9);
  const auto alone = false_runs(some_runs(1), {false}, std::vector{7.0});
  EXPECT_EQ(alone.log_follows, std::vector{0.0});
  EXPECT_NEAR(alone.log_evidence, 0.0, 1e-9);
}

}  // namespace
}  // namespace isotherm::slam::detail
