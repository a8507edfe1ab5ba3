#include "edges/odds/edge_odds.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr double kMean = 3.0;  // of the pairs; true edges have mean 0, both deviation 1

/// Two features: one that tells, in any unit, and one that does not.
Eigen::MatrixXd rows(Random& random, int count, double mean, double unit = 1.0) {
  Eigen::MatrixXd found(count, 2);
  for (int k = 0; k < count; ++k) found.row(k) << unit * random.normal(mean, 1.0), random.normal();
  return found;
}

struct Sample {
  PairFeatures features;
  int false_count = 0;
};

Sample mixture(Random& random, int true_count, int false_count, double unit = 1.0) {
  Sample sample{{Eigen::MatrixXd(true_count + false_count, 2), rows(random, 5000, kMean, unit)},
                false_count};
  sample.features.edges << rows(random, true_count, 0.0, unit),
      rows(random, false_count, kMean, unit);
  return sample;
}

EdgeOdds settle(const PairFeatures& features) {
  std::vector<double> truth;
  for (Eigen::Index k = 0; k < features.edges.rows(); ++k) {
    truth.push_back(features.edges(k, 0) < 0.5 * features.pairs.col(0).mean() ? 1.0 : 0.0);
  }
  auto found = edge_odds(features, truth);
  for (int round = 0; round < 20; ++round) found = edge_odds(features, found.truth);
  return found;
}

TEST(EdgeOdds, AreThoseOfTwoNormalDistributions) {
  // log (f_pairs / f_true) = m x - m^2 / 2.
  Random random(11);
  const auto sample = mixture(random, 18'000, 2000);
  const auto found = settle(sample.features);
  EXPECT_NEAR(found.false_count, sample.false_count, 150.0);
  double worst = 0.0, worst_truth = 0.0;
  for (Eigen::Index k = 0; k < sample.features.edges.rows(); ++k) {
    const double expected = kMean * sample.features.edges(k, 0) - 0.5 * kMean * kMean;
    worst = std::max(worst, std::abs(found.scores[k] - expected));
    const double truth = 1.0 / (1.0 + std::exp(expected) * 2.0 / 18.0);
    worst_truth = std::max(worst_truth, std::abs(found.truth[k] - truth));
  }
  EXPECT_LT(worst, 1.5);  // of up to 15
  EXPECT_LT(worst_truth, 0.06);
}

TEST(EdgeOdds, DoNotDependOnTheUnit) {
  Random first(12), second(12);
  const auto one = mixture(first, 900, 100);
  const auto other = mixture(second, 900, 100, 1e6);
  const auto a = settle(one.features), b = settle(other.features);
  for (std::size_t k = 0; k < a.scores.size(); ++k) EXPECT_NEAR(a.scores[k], b.scores[k], 1e-4);
}

TEST(EdgeOdds, WhatExplainsMoreHasTheHigherEvidence) {
  Random random(13);
  const auto sample = mixture(random, 950, 50);
  auto untold = sample.features;
  untold.edges.col(0).setZero();
  untold.pairs.col(0).setZero();
  const std::vector<double> all_true(1000, 1.0);
  const auto told = settle(sample.features);
  EXPECT_GT(told.log_evidence, edge_odds(untold, all_true).log_evidence + 1000.0);
  EXPECT_NEAR(edge_odds(untold, all_true).log_evidence, 0.0, 5.0);
}

TEST(EdgeOdds, SuspectNothingWhereNothingIsFalse) {
  Random random(14);
  const PairFeatures features{rows(random, 2000, 0.0), rows(random, 2000, 8.0)};
  const auto found = edge_odds(features, std::vector<double>(2000, 1.0));
  EXPECT_LT(found.false_count, 1.0);
  for (const double p : found.truth) EXPECT_GT(p, 0.99);
  EXPECT_TRUE(std::isfinite(found.log_evidence));
}

TEST(EdgeOdds, TakeDegenerateInput) {
  EXPECT_TRUE(edge_odds({Eigen::MatrixXd(0, 2), Eigen::MatrixXd(0, 2)}, {}).scores.empty());
  const Eigen::MatrixXd same = Eigen::MatrixXd::Ones(5, 2);
  const std::vector<double> all_true(5, 1.0), all_false(5, 0.0);
  EXPECT_EQ(edge_odds({same, Eigen::MatrixXd(0, 2)}, all_true).truth, all_true);
  EXPECT_EQ(edge_odds({same, same}, all_false).truth, all_false);
  for (const double p : edge_odds({same, same}, all_true).truth) {
    EXPECT_GE(p, 0.0);
    EXPECT_LE(p, 1.0);
  }
}

}  // namespace
}  // namespace isotherm::spectral::detail
