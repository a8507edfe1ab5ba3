#include "prune/consensus/runs/false_loops.hpp"

#include <algorithm>
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

/// Of what the loops say: that they follow, and that their place is right.
struct Told {
  std::vector<double> log_led;
  std::vector<double> log_place;
};

// Plain in every third, and random by so much besides.
Told random_told(std::size_t loops, double plain) {
  Random random(5);
  Told told;
  for (std::size_t k = 0; k < loops; ++k) {
    told.log_led.push_back(random.normal() + (k % 3 == 0 ? plain : -plain));
    told.log_place.push_back(random.normal() + (k % 3 == 1 ? plain : -plain));
  }
  return told;
}

// log of the integral over the share of those of the right place, of density (1 - c)^(n - 1) n with
// n = kFalseByChance, of the product of how likely each loop is, by the midpoint rule.
double exact_evidence(const Runs<Pose2>& runs, const Told& told) {
  constexpr int kParts = 20000;
  double sum = -1e300;
  for (int j = 0; j < kParts; ++j) {
    const double right = (j + 0.5) / kParts;
    double log_product =
        std::log(kFalseByChance / kParts) + (kFalseByChance - 1.0) * std::log1p(-right);
    for (std::size_t k = 0; k < told.log_led.size(); ++k) {
      const double alone = log_sum(std::log1p(-right), std::log(right) + told.log_place[k]);
      const bool led = runs.leader(static_cast<Index>(k)) != Runs<Pose2>::kNone;
      log_product += led ? log_sum(std::log1p(-kFalseFollowing) + alone,
                                   std::log(kFalseFollowing) + told.log_led[k])
                         : alone;
    }
    sum = log_sum(sum, log_product);
  }
  return sum;
}

// Where it is plain which of them are which the bound is exact.
TEST(FalseLoops, IntegrateOutHowManyAreOfTheRightPlace) {
  const auto runs = some_runs(40);
  const std::vector<bool> accepted(40, false);
  for (const double plain : {0.0, 5.0, 30.0}) {
    const Told told = random_told(40, plain);
    const auto found = false_loops(runs, accepted, told.log_led, told.log_place);
    const double exact = exact_evidence(runs, told);
    EXPECT_LE(found.log_evidence, exact + 1e-3) << plain;
    EXPECT_NEAR(found.log_evidence, exact, plain > 20.0 ? 1e-3 : 1.0) << plain;
  }
}

// One that the one before leads is so where that agrees, and by itself where it does not.
TEST(FalseLoops, FollowOnlyFalseOnesThatAreAlike) {
  const auto runs = some_runs(40);
  std::vector<bool> accepted(40, false);
  for (std::size_t k = 0; k < 10; ++k) accepted[k] = true;
  Told told = random_told(40, 3.0);
  told.log_led[38] = 1e4;
  told.log_led[39] = -1e4;
  const auto found = false_loops(runs, accepted, told.log_led, told.log_place);
  std::size_t followers = 0;
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    const Index before = runs.leader(static_cast<Index>(k));
    if (before == Runs<Pose2>::kNone || accepted[k] || accepted[before]) {
      EXPECT_EQ(found.log_follows[k], 0.0) << k;
    } else {
      ++followers;
      const double led = told.log_led[k] - found.log_alone(told.log_place[k]);
      const double least = std::min(led, 700.0);
      const double exact = std::log(1.0 - kFalseFollowing + kFalseFollowing * std::exp(least));
      EXPECT_NEAR(found.log_follows[k], exact + led - least, 1e-9) << k;
    }
  }
  EXPECT_GT(followers, 10U);
}

// The more are, the likelier the next one is; of accepted ones nothing is told.
TEST(FalseLoops, AreOfTheRightPlaceWhereTheMapHasThemNear) {
  const auto runs = some_runs(40);
  const std::vector<double> log_led(40, -50.0);
  const std::vector<double> log_place(40, 8.0);
  std::vector<bool> accepted(40, true);
  const auto none = false_loops(runs, accepted, log_led, log_place);
  EXPECT_NEAR(none.log_evidence, 0.0, 1e-9);
  EXPECT_NEAR(none.log_right, -std::log(1.0 + kFalseByChance), 1e-9);
  double before = none.log_alone(8.0);
  for (std::size_t some = 0; some < 40; some += 10) {
    std::fill_n(accepted.begin(), some + 10, false);
    const auto found = false_loops(runs, accepted, log_led, log_place);
    EXPECT_GT(found.log_alone(8.0), before + 0.1) << some;
    EXPECT_LT(found.log_alone(8.0), 8.0) << some;
    EXPECT_LT(found.log_alone(-8.0), 0.0) << some;
    EXPECT_GT(found.log_evidence, 0.0) << some;
    before = found.log_alone(8.0);
  }
}

TEST(FalseLoops, OfNoLoopsSayNothing) {
  const auto none = false_loops(some_runs(0), {}, {}, {});
  EXPECT_TRUE(none.log_follows.empty());
  EXPECT_NEAR(none.log_evidence, 0.0, 1e-9);
  const auto alone = false_loops(some_runs(1), {false}, std::vector{7.0}, std::vector{0.0});
  EXPECT_EQ(alone.log_follows, std::vector{0.0});
  EXPECT_LE(alone.log_evidence, 1e-9);
  EXPECT_NEAR(alone.log_evidence, 0.0, 1.0 / kFalseByChance);
}

}  // namespace
}  // namespace isotherm::slam::detail
