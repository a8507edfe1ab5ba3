#include "isotherm/network/localize/range_mixture.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace isotherm::network {
namespace {

RangeMixture model_of(double excess) {
  RangeMixture model;
  model.share = {0.6, 0.3, 0.1};
  model.excess = excess;
  model.longest = 50.0;
  return model;
}

// The mixture by its definition: the excess integrated out by the trapezoidal rule.
struct Integrated {
  double density = 0.0;
  ByKind kinds{};
  double squared_noise = 0.0;
  double excess = 0.0;
};

Integrated integrated(const RangeMixture& model, double error, double sigma) {
  const auto normal = [&](double z) {
    return std::exp(-0.5 * z * z / (sigma * sigma)) / (sigma * std::sqrt(2.0 * std::numbers::pi));
  };
  Integrated result;
  const int steps = 400000;
  const double far = std::max(0.0, error) + 12.0 * sigma;
  const double width = far / steps;
  for (int i = 0; i <= steps; ++i) {
    const double excess = i * width;
    const double weight = width * (i == 0 || i == steps ? 0.5 : 1.0);
    const double density =
        weight * std::exp(-excess / model.excess) / model.excess * normal(error - excess);
    result.kinds[kTooLong] += density;
    result.squared_noise += density * std::pow((error - excess) / sigma, 2);
    result.excess += density * excess;
  }
  for (double* part : {&result.kinds[kTooLong], &result.squared_noise, &result.excess}) {
    *part *= model.share[kTooLong];
  }
  result.kinds[kCorrect] = model.share[kCorrect] * normal(error);
  result.kinds[kAnything] = model.share[kAnything] / model.longest;
  result.squared_noise += result.kinds[kCorrect] * error * error / (sigma * sigma);
  for (const double kind : result.kinds) result.density += kind;
  return result;
}

TEST(RangeMixture, TheDensityIsThatOfANormalErrorAndAnExponentialExcess) {
  for (const double excess : {0.3, 2.0, 20.0}) {
    const auto model = model_of(excess);
    for (const double error : {-2.0, -0.3, 0.0, 0.4, 1.0, 6.0}) {
      const double sigma = 0.4;
      const auto oracle = integrated(model, error, sigma);
      const auto loss = range_loss(model, error, sigma * sigma);
      EXPECT_NEAR(loss.cost, -std::log(oracle.density), 1e-6);
      for (std::size_t kind = 0; kind < kRangeKinds; ++kind) {
        EXPECT_NEAR(loss.probability[kind], oracle.kinds[kind] / oracle.density, 1e-6);
      }
      const auto moments = range_moments(model, error, sigma * sigma);
      EXPECT_NEAR(moments.squared_noise, oracle.squared_noise / oracle.density, 1e-5);
      EXPECT_NEAR(moments.excess, oracle.excess / oracle.density, 1e-5);
    }
  }
}

TEST(RangeMixture, TheSlopeIsTheDerivativeOfTheCost) {
  const auto model = model_of(1.5);
  const double h = 1e-5;
  for (double error = -8.0; error < 12.0; error += 0.37) {
    const double by_difference =
        (range_loss(model, error + h, 0.16).cost - range_loss(model, error - h, 0.16).cost) /
        (2.0 * h);
    const auto loss = range_loss(model, error, 0.16);
    EXPECT_NEAR(loss.slope, by_difference, 1e-6) << error;
    EXPECT_GE(loss.curvature, 0.0);
    EXPECT_LE(loss.curvature, 1.0 / 0.16 + 1e-12);
  }
}

TEST(RangeMixture, WhatIsFarOffSaysNothing) {
  const auto model = model_of(0.01);
  for (const double error : {-1e6, -100.0, 1e6}) {
    const auto loss = range_loss(model, error, 1e-6);
    EXPECT_TRUE(std::isfinite(loss.cost)) << error;
    EXPECT_NEAR(loss.probability[kAnything], 1.0, 1e-9) << error;
    EXPECT_NEAR(loss.slope, 0.0, 1e-6) << error;
    EXPECT_NEAR(loss.curvature, 0.0, 1e-6) << error;
  }
}

TEST(RangeMixture, WithoutBiasNothingIsTooLong) {
  auto model = model_of(1.0);
  model.share = {0.9, 0.0, 0.1};
  const auto loss = range_loss(model, 1.0, 0.25);
  EXPECT_EQ(loss.probability[kTooLong], 0.0);
  EXPECT_TRUE(std::isfinite(loss.cost));
}

TEST(RangeMixture, ScaleAndKindsAreLearnedFromWhatIsThere) {
  RangeStatistics statistics;
  statistics.count = {800.0, 150.0, 50.0};
  statistics.squared_noise = 4.0 * 950.0;
  statistics.excess = 150.0 * 2.5;
  RangeMixture model;
  learn_kinds(statistics, 1.0, 0.0, true, model);
  EXPECT_NEAR(model.share[kTooLong], 151.0 / 1003.0, 1e-12);
  EXPECT_NEAR(model.excess, 2.5, 0.02);
  EXPECT_NEAR(most_likely_scale(statistics, 0.0, 1.0), 2.0, 0.01);
  EXPECT_NEAR(most_likely_scale(statistics, 475.0, 1.0), 2.0 * std::sqrt(2.0), 0.01);
  // Nothing measured leaves what is stated.
  EXPECT_NEAR(most_likely_scale({}, 0.0, 1.0), 1.0, 1e-9);
  EXPECT_NEAR(most_likely_variance(0.0, 0.0), 1.0, 1e-9);
}

}  // namespace
}  // namespace isotherm::network
