#include "edges/odds/two_groups.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"

namespace isotherm::spectral::detail {
namespace {

using testing::Each;

std::vector<double> normals(Random& random, int count, double mean, double sigma) {
  std::vector<double> values(count);
  for (double& value : values) value = random.normal(mean, sigma);
  return values;
}

TEST(TwoGroups, FindsTheProbabilitiesOfAMixture) {
  Random random(3);
  auto scores = normals(random, 20'000, 0.0, 1.0);
  const auto false_ones = normals(random, 5000, 4.0, 1.5);
  scores.insert(scores.end(), false_ones.begin(), false_ones.end());
  const auto groups = separate_groups(scores, normals(random, 20'000, 4.0, 1.5));
  EXPECT_NEAR(groups.false_count, 5000.0, 300.0);
  double worst = 0.0;
  for (std::size_t k = 0; k < scores.size(); ++k) {
    const double x = scores[k];
    const double true_density = 20'000 * std::exp(-0.5 * x * x);
    const double false_density = 5000 / 1.5 * std::exp(-0.5 * (x - 4.0) * (x - 4.0) / 2.25);
    if (std::abs(x) > 5.0) continue;
    worst =
        std::max(worst, std::abs(groups.truth[k] - true_density / (true_density + false_density)));
  }
  EXPECT_LT(worst, 0.15);
}

TEST(TwoGroups, ProbabilityNeverRisesWithTheScore) {
  Random random(4);
  auto scores = normals(random, 500, 0.0, 2.0);
  std::sort(scores.begin(), scores.end());
  const auto truth = separate_groups(scores, normals(random, 700, 1.0, 1.0)).truth;
  EXPECT_TRUE(std::is_sorted(truth.rbegin(), truth.rend()));
  for (const double p : truth) {
    EXPECT_GE(p, 0.0);
    EXPECT_LE(p, 1.0);
  }
}

TEST(TwoGroups, NothingFalseNothingSuspected) {
  Random random(5);
  const auto scores = normals(random, 1000, 0.0, 1.0);
  const auto groups = separate_groups(scores, normals(random, 1000, 20.0, 1.0));
  EXPECT_EQ(groups.false_count, 0.0);
  EXPECT_THAT(groups.truth, Each(1.0));
  EXPECT_THAT(separate_groups(scores, {}).truth, Each(1.0));
  EXPECT_TRUE(separate_groups({}, scores).truth.empty());
}

TEST(TwoGroups, EqualScoresShareOneProbability) {
  const std::vector<double> scores = {1.0, 1.0, 1.0, 1.0, 9.0, 9.0};
  const std::vector<double> nulls = {9.0, 9.0, 9.0};
  const auto truth = separate_groups(scores, nulls).truth;
  EXPECT_EQ(truth[0], 1.0);
  EXPECT_EQ(truth[4], truth[5]);
  EXPECT_LT(truth[4], 0.5);
  EXPECT_THAT(separate_groups(nulls, nulls).truth, Each(0.0));
}

TEST(TwoGroups, RejectsNoMoreThanThereAreFalseOnes) {
  const std::vector<double> scores = {5.0, 1.0, 4.0, 2.0, 3.0};
  const TwoGroups groups = {{0.0, 0.9, 0.2, 0.8, 0.5}, 4.0};
  EXPECT_EQ(by_suspicion(scores), (std::vector<Index>{0, 2, 4, 3, 1}));
  EXPECT_EQ(rejection_threshold(scores, groups, 0.7), 2.0);
  EXPECT_EQ(rejection_threshold(scores, groups, 0.4), 3.0);
  EXPECT_EQ(rejection_threshold(scores, {groups.truth, 1.5}, 0.7), 3.0);
  EXPECT_TRUE(std::isinf(rejection_threshold(scores, {groups.truth, 0.0}, 0.7)));
  EXPECT_TRUE(std::isinf(rejection_threshold({}, {}, 0.7)));
}

TEST(TwoGroups, CalibratesAScoreByProbabilitiesFromElsewhere) {
  const std::vector<double> scores = {1.0, 2.0, 3.0, 3.0, 4.0, 5.0};
  const std::vector<double> truth = {1.0, 0.8, 1.0, 0.6, 0.1, 0.3};
  const auto groups = calibrate(scores, truth);
  EXPECT_NEAR(groups.false_count, 2.2, 1e-12);
  // 2 and both 3 are pooled with each other, and so are 4 and 5.
  const std::vector<double> expected = {1.0, 0.8, 0.8, 0.8, 0.2, 0.2};
  for (std::size_t k = 0; k < scores.size(); ++k) EXPECT_NEAR(groups.truth[k], expected[k], 1e-12);
}

TEST(TwoGroups, TheThresholdOfTheBestFTakesEqualScoresTogether) {
  const std::vector<double> scores = {5.0, 5.0, 5.0, 4.0, 1.0, 1.0};
  const TwoGroups groups{{0.2, 0.2, 0.2, 0.4, 0.9, 0.9}, 3.2};
  // F of three rejected: 2 * 2.4 / 6.2; of four: 2 * 3 / 7.2, the highest.
  EXPECT_EQ(threshold_of_best_f(scores, groups, 0.8), 1.0);
  EXPECT_EQ(threshold_of_best_f(scores, groups, 0.3), 4.0);
  EXPECT_TRUE(std::isinf(threshold_of_best_f(scores, groups, 0.1)));
  const TwoGroups all{{0.1, 0.1}, 1.8};
  EXPECT_LT(threshold_of_best_f(std::vector{2.0, 2.0}, all, 0.8), 2.0);
}

}  // namespace
}  // namespace isotherm::spectral::detail
