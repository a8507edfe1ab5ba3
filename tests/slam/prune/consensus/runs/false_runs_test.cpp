#include "prune/consensus/runs/false_runs.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "prune/consensus/constants.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;

Runs<Pose2> some_runs(Index loops) {
  Random random(12);
  const auto made = random_loop_graph<Pose2>(random, 30, loops, 1.0);
  return {reduce(made.graph, edge_roles(made.graph)), 20};
}

// One that the one before leads is so where that agrees, and by chance where it does not.
TEST(FalseRuns, FollowOnlyFalseOnesThatAreAlike) {
  const auto runs = some_runs(40);
  std::vector<bool> accepted(40, false);
  for (std::size_t k = 0; k < 10; ++k) accepted[k] = true;
  Random random(5);
  std::vector<double> log_led(40);
  for (double& led : log_led) led = 3.0 * random.normal();
  log_led[38] = 1e4;
  log_led[39] = -1e4;
  const auto found = log_follows(runs, accepted, log_led);
  std::size_t followers = 0;
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    const Index before = runs.leader(static_cast<Index>(k));
    if (before == Runs<Pose2>::kNone || accepted[k] || accepted[before]) {
      EXPECT_EQ(found[k], 0.0) << k;
    } else {
      ++followers;
      const double led = std::min(log_led[k], 700.0);
      const double exact = std::log(1.0 - kFalseFollowing + kFalseFollowing * std::exp(led));
      EXPECT_NEAR(found[k], exact + log_led[k] - led, 1e-9) << k;
    }
  }
  EXPECT_GT(followers, 10U);
}

TEST(FalseRuns, OfNoLoopsSayNothing) {
  EXPECT_TRUE(log_follows(some_runs(0), {}, {}).empty());
  EXPECT_EQ(log_follows(some_runs(1), {false}, std::vector{7.0}), std::vector{0.0});
}

}  // namespace
}  // namespace isotherm::slam::detail
