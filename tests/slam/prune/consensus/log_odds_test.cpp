#include "prune/consensus/log_odds.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace isotherm::slam::detail {
namespace {

TEST(LogOdds, GoThereAndBack) {
  for (const double odds : {-30.0, -4.6, 0.0, 4.6, 20.0}) {
    EXPECT_NEAR(log_odds_of(probability_of(odds)), odds, 1e-6);
  }
}

TEST(LogOdds, GiveNoSubnormalProbability) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double odds : {-700.0, -708.0, -720.0, -740.0, -1e300, -kInfinity, kInfinity}) {
    const double probability = probability_of(odds);
    EXPECT_TRUE(probability == 0.0 || std::isnormal(probability)) << odds;
  }
  EXPECT_EQ(probability_of(-kInfinity), 0.0);
  EXPECT_EQ(probability_of(kInfinity), 1.0);
}

}  // namespace
}  // namespace isotherm::slam::detail
