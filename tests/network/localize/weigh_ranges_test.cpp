#include "localize/refine/weigh_ranges.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "network/localize/networks.hpp"

namespace isotherm::network::detail {
namespace {

constexpr double kSigma = 0.02;

// Nodes anywhere in the unit square, all of which measure each other.
Eigen::MatrixXd scattered(Index nodes, Random& random) {
  Eigen::MatrixXd truth(2, nodes);
  for (Index v = 0; v < nodes; ++v) {
    truth.col(v) << random.uniform(0.0, 1.0), random.uniform(0.0, 1.0);
  }
  return truth;
}

// Of the ranges, noisy, the first so many are too long by a bit more than noise on average.
struct Case {
  Eigen::MatrixXd truth;
  RangeNetwork network;
  RangeProblem problem;
  Placement placement;

  Case(Index nodes, std::size_t too_long) {
    Random random(7);
    truth = scattered(nodes, random);
    std::vector<int> all;
    for (Index v = 0; v < nodes; ++v) all.push_back(static_cast<int>(v));
    network = exact_network(truth, all_pairs(all), {0, 1, 2});
    auto& ranges = network.ranges;
    for (std::size_t k = ranges.size(); k > 1; --k) {
      std::swap(ranges[k - 1], ranges[static_cast<std::size_t>(random.index(k))]);
    }
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      const double excess = k < too_long ? -0.15 * std::log(random.uniform(1e-9, 1.0)) : 0.0;
      ranges[k].distance = std::abs(random.normal(ranges[k].distance, kSigma)) + excess;
      ranges[k].variance = kSigma * kSigma;
    }
    problem = make_problem(network);
    placement = anchors_only(network, problem);
    for (Index v = 0; v < nodes; ++v) {
      if (problem.is_anchor[v]) continue;
      placement.placed[v] = true;
      placement.positions.col(v) = truth.col(v);
    }
  }

  double error() const {
    return (placement.positions - truth).norm() / std::sqrt(static_cast<double>(truth.cols()));
  }
};

TEST(WeighRanges, WhatIsTooLongIsFoundAndPullsHardly) {
  const std::size_t wrong = 60;
  Case c(20, wrong);
  const auto weighed = weigh_ranges(c.problem, {}, {}, c.placement);
  EXPECT_TRUE(weighed.too_long);
  EXPECT_NEAR(weighed.model.share[kTooLong], 60.0 / 190.0, 0.08);
  EXPECT_NEAR(weighed.model.excess, 0.15, 0.05);
  // As well as from the correct ones, nearly.
  EXPECT_LT(c.error(), 2.0 * kSigma / std::sqrt(13.0 / 2.0));
  const auto judged = judge_ranges(c.problem, weighed, c.placement);
  for (std::size_t k = 0; k < judged.size(); ++k) {
    const auto& range = c.network.ranges[k];
    const double off =
        (range.distance - (c.truth.col(range.from) - c.truth.col(range.to)).norm()) / kSigma;
    if (c.problem.is_anchor[range.from] && c.problem.is_anchor[range.to]) continue;
    ASSERT_TRUE(judged[k].checked);
    if (off > 6.0) {
      EXPECT_LT(judged[k].loss.probability[kCorrect], 0.1);
    }
    if (std::abs(off) < 1.0) {
      EXPECT_GT(judged[k].loss.probability[kCorrect], 0.5);
    }
  }
}

TEST(WeighRanges, WhereNothingIsTooLongThereIsMoreEvidenceForNoSuchKind) {
  Case c(20, 0);
  const auto weighed = weigh_ranges(c.problem, {}, {}, c.placement);
  EXPECT_FALSE(weighed.too_long);
  EXPECT_EQ(weighed.model.share[kTooLong], 0.0);
  double fitted = 0.0;
  for (const auto& range : judge_ranges(c.problem, weighed, c.placement)) fitted += range.fitted;
  // As many degrees of freedom as there are unknowns.
  EXPECT_NEAR(fitted, 2.0 * 17.0, 0.5);
}

TEST(JudgeRanges, NoTieFitsAPartThatIsElsewhere) {
  Case c(10, 0);
  auto weighed = weigh_ranges(c.problem, {}, {}, c.placement);
  for (Index v = 0; v < 10; ++v) {
    if (!c.problem.is_anchor[v]) c.placement.positions.col(v) += Eigen::Vector2d(3.0, 4.0);
  }
  const auto crosses = [&](std::size_t k) {
    const auto& range = c.problem.ranges[k];
    return c.problem.is_anchor[range.from] != c.problem.is_anchor[range.to];
  };
  for (std::size_t k = 0; k < weighed.weighs.size(); ++k) {
    weighed.weighs[k] = weighed.weighs[k] && !crosses(k);
  }
  const auto judged = judge_ranges(c.problem, weighed, c.placement);
  for (std::size_t k = 0; k < judged.size(); ++k) {
    EXPECT_EQ(judged[k].fits, !crosses(k));
  }
}

// The gradient of the density vanishes where it is said to be largest.
TEST(WeighRanges, EndsAtAMaximumOfTheDensity) {
  Case c(12, 20);
  const auto weighed = weigh_ranges(c.problem, {}, {}, c.placement);
  const auto cost = [&] {
    double sum = 0.0;
    for (std::size_t k = 0; k < c.problem.ranges.size(); ++k) {
      const auto& range = c.problem.ranges[k];
      const double length =
          (c.placement.positions.col(range.from) - c.placement.positions.col(range.to)).norm();
      sum += range_loss(weighed.model, range.distance - length, kSigma * kSigma).cost;
    }
    return sum;
  };
  const double least = cost();
  for (Index v = 3; v < c.problem.nodes; ++v) {
    for (int i = 0; i < 2; ++i) {
      for (const double step : {-0.2 * kSigma, 0.2 * kSigma}) {
        c.placement.positions(i, v) += step;
        EXPECT_GT(cost(), least - 2e-3);
        c.placement.positions(i, v) -= step;
      }
    }
  }
}

}  // namespace
}  // namespace isotherm::network::detail
