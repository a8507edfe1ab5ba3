#include "isotherm/spectral/edges/threshold.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::spectral {
namespace {

constexpr std::array kAdaptive = {ThresholdRule::otsu, ThresholdRule::mixture, ThresholdRule::gap};

TEST(Threshold, MeanSigmaIsEquation11) {
  const std::vector<double> distances = {1, 2, 3, 4};
  const auto threshold = find_threshold(distances, {.konst = 2.0});
  EXPECT_DOUBLE_EQ(threshold.value, 2.5 + 2.0 * std::sqrt(1.25));
  EXPECT_FALSE(threshold.degenerate);
}

TEST(Threshold, AdaptiveRulesSeparateTwoGroups) {
  Random random(1);
  std::vector<double> distances;
  for (int k = 0; k < 300; ++k) distances.push_back(std::exp(random.normal(-5.0, 0.3)));
  for (int k = 0; k < 60; ++k) distances.push_back(std::exp(random.normal(0.0, 0.3)));
  for (const auto rule : kAdaptive) {
    const auto threshold = find_threshold(distances, {.rule = rule});
    EXPECT_GT(threshold.value, std::exp(-4.0)) << enum_name(rule);
    EXPECT_LT(threshold.value, std::exp(-0.5)) << enum_name(rule);
    EXPECT_GT(threshold.separation, 0.75) << enum_name(rule);
  }
}

TEST(Threshold, OneGroupHasLittleSeparation) {
  Random random(2);
  std::vector<double> distances;
  for (int k = 0; k < 500; ++k) distances.push_back(std::exp(random.normal(0.0, 0.2)));
  EXPECT_LT(find_threshold(distances, {.rule = ThresholdRule::mixture}).separation, 0.7);
}

TEST(Threshold, OrderDoesNotMatter) {
  const std::vector<double> up = {0.1, 0.11, 0.12, 0.9, 0.95};
  const std::vector<double> down(up.rbegin(), up.rend());
  for (const auto rule : kAdaptive) {
    EXPECT_EQ(find_threshold(up, {.rule = rule}).value, find_threshold(down, {.rule = rule}).value);
  }
}

TEST(Threshold, NothingToSplit) {
  for (const auto& distances : {std::vector<double>{}, std::vector<double>{0.3},
                                std::vector<double>{2, 2, 2}, std::vector<double>{0, 0}}) {
    for (const auto rule : kAdaptive) {
      const auto threshold = find_threshold(distances, {.rule = rule});
      EXPECT_TRUE(threshold.degenerate);
      EXPECT_EQ(threshold.value, std::numeric_limits<double>::infinity());
    }
  }
  EXPECT_TRUE(find_threshold({}).degenerate);
  EXPECT_EQ(find_threshold(std::vector{0.3}).value, 0.3);
}

TEST(Threshold, ZerosAreSmallDistances) {
  const std::vector<double> distances = {0.0, 0.0, 0.0, 1.0, 1.1};
  for (const auto rule : kAdaptive) {
    const auto threshold = find_threshold(distances, {.rule = rule});
    EXPECT_GT(threshold.value, 0.0);
    EXPECT_LT(threshold.value, 1.0);
  }
}

TEST(Threshold, RejectsWhatIsNoDistance) {
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(find_threshold(std::vector{1.0, bad}), InvalidArgument);
  }
  EXPECT_THROW(find_threshold(std::vector{1.0}, {.konst = std::nan("")}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::spectral
