// Whether false loop closures have the distributions their styles and types state.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/slam/simulate/simulate.hpp"

namespace isotherm::slam {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Index kPoses = 1000;

// Both tests reject one true distribution in a thousand; seeds are fixed.
constexpr double kSignificance = 0.001;

// Kolmogorov and Smirnov's test of a continuous distribution.
void expect_distribution(std::vector<double> values, const std::function<double(double)>& cdf) {
  ASSERT_GT(values.size(), 100u);
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double distance = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double p = cdf(values[k]);
    distance =
        std::max({distance, p - static_cast<double>(k) / n, static_cast<double>(k + 1) / n - p});
  }
  EXPECT_LT(distance * std::sqrt(n), std::sqrt(-0.5 * std::log(0.5 * kSignificance)));
}

std::function<double(double)> normal_cdf(double sigma) {
  return [sigma](double x) { return 0.5 * std::erfc(-x / (sigma * std::numbers::sqrt2)); };
}

std::function<double(double)> uniform_cdf(double low, double high) {
  return [=](double x) { return std::clamp((x - low) / (high - low), 0.0, 1.0); };
}

// Pearson's test that every whole number in [low, high] comes equally often.
void expect_uniform(const std::vector<Index>& values, Index low, Index high) {
  std::map<Index, double> counts;
  for (const Index value : values) {
    EXPECT_GE(value, low);
    EXPECT_LE(value, high);
    counts[value] += 1.0;
  }
  const auto cells = static_cast<double>(high - low + 1);
  const double expected = static_cast<double>(values.size()) / cells;
  double chi2 = 0.0;
  for (Index value = low; value <= high; ++value) {
    chi2 += std::pow(counts[value] - expected, 2) / expected;
  }
  EXPECT_LT(chi2, chi_squared_quantile(1.0 - kSignificance, static_cast<int>(cells) - 1));
}

const Simulation<Pose2>& planar() {
  static const auto world =
      simulate_city({.poses = kPoses, .measurements = {.loops = 300}, .seed = 1});
  return world;
}

const Simulation<Pose3>& spatial() {
  static const auto world =
      simulate_sphere({.poses = kPoses, .measurements = {.loops = 300}, .seed = 1});
  return world;
}

// The injected constraints, in the order in which they were made.
template <class Pose>
std::vector<Constraint<Pose>> injected(const Simulation<Pose>& world, CorruptOptions options) {
  options.count = 4000;
  options.shuffle = false;
  const auto corrupted = corrupt(world.graph, world.truth, options);
  const auto& constraints = corrupted.graph.constraints;
  return {constraints.end() - options.count, constraints.end()};
}

template <class Loops, class Value>
auto values_of(const Loops& loops, const Value& value) {
  std::vector<decltype(value(loops.front()))> values;
  for (const auto& loop : loops) values.push_back(value(loop));
  return values;
}

TEST(CorruptStatistics, RandomEndsAreUniform) {
  for (const auto style : {NoiseStyle::vertigo, NoiseStyle::paper}) {
    const auto loops = injected(planar(), {.style = style, .type = NoiseType::random});
    // Direction follows the graph, so the ends are looked at together.
    auto ends = values_of(loops, [](const auto& loop) { return loop.from / 100; });
    const auto others = values_of(loops, [](const auto& loop) { return loop.to / 100; });
    ends.insert(ends.end(), others.begin(), others.end());
    expect_uniform(ends, 0, kPoses / 100 - 1);
  }
}

TEST(CorruptStatistics, LocalEndsAreUniformlyFarApart) {
  const auto lengths = [](const auto& world, NoiseStyle style) {
    auto loops = injected(world, {.style = style, .type = NoiseType::local});
    // At the ends of the path there is less room.
    std::erase_if(loops, [](const auto& loop) {
      return std::min(loop.from, loop.to) < 80 || std::max(loop.from, loop.to) > kPoses - 80;
    });
    return values_of(loops, [](const auto& loop) { return std::abs(loop.to - loop.from); });
  };
  expect_uniform(lengths(planar(), NoiseStyle::vertigo), 2, 20);
  expect_uniform(lengths(spatial(), NoiseStyle::vertigo), 2, 20);
  expect_uniform(lengths(planar(), NoiseStyle::paper), 2, 40);
}

TEST(CorruptStatistics, VertigoTransformsAreNormalNearTheIdentity) {
  const auto loops = injected(planar(), {.style = NoiseStyle::vertigo});
  for (int axis = 0; axis < 2; ++axis) {
    expect_distribution(
        values_of(loops, [&](const auto& loop) { return loop.T_from_to.translation()[axis]; }),
        normal_cdf(0.3));
  }
  expect_distribution(values_of(loops, [](const auto& loop) { return loop.T_from_to.angle(); }),
                      normal_cdf(10.0 * kPi / 180.0));
}

TEST(CorruptStatistics, VertigoTransformsAreNormalInSpace) {
  const auto loops = injected(spatial(), {.style = NoiseStyle::vertigo, .seed = 2});
  for (int axis = 0; axis < 3; ++axis) {
    expect_distribution(
        values_of(loops, [&](const auto& loop) { return loop.T_from_to.translation()[axis]; }),
        normal_cdf(0.3));
    expect_distribution(
        values_of(loops, [&](const auto& loop) { return loop.T_from_to.log()[3 + axis]; }),
        normal_cdf(10.0 * kPi / 180.0));
  }
}

template <class Pose>
void expect_wild_transforms(const Simulation<Pose>& world) {
  const auto loops = injected(world, {.style = NoiseStyle::paper, .seed = 3});
  const auto lengths =
      values_of(loops, [](const auto& loop) { return loop.T_from_to.translation().norm(); });
  std::vector<double> magnitudes;
  for (const double length : lengths) magnitudes.push_back(std::log10(length));
  expect_distribution(magnitudes, uniform_cdf(1.0, 3.0));
  expect_distribution(
      values_of(loops, [](const auto& loop) { return loop.T_from_to.rotation_angle(); }),
      uniform_cdf(0.0, kPi));
  // No direction is preferred: the cosine to an axis is arcsine-distributed in the
  // plane and uniform in space.
  const auto cosine_cdf = [](double x) {
    return Pose::kDim == 2 ? 1.0 - std::acos(std::clamp(x, -1.0, 1.0)) / kPi : 0.5 * (x + 1.0);
  };
  for (int axis = 0; axis < Pose::kDim; ++axis) {
    expect_distribution(values_of(loops,
                                  [&](const auto& loop) {
                                    const auto& t = loop.T_from_to.translation();
                                    return t[axis] / t.norm();
                                  }),
                        cosine_cdf);
  }
}

TEST(CorruptStatistics, PaperTransformsAreWildInEveryDirection) {
  expect_wild_transforms(planar());
  expect_wild_transforms(spatial());
}

TEST(CorruptStatistics, PaperInformationIsTheMeanTimesAUniformFactor) {
  const auto& graph = planar().graph;
  const auto roles = edge_roles(graph);
  Pose2::Matrix mean = Pose2::Matrix::Zero();
  for (const Index k : roles.candidates) mean += graph.constraints[k].information;
  mean /= static_cast<double>(roles.candidates.size());
  const auto loops = injected(
      planar(), {.style = NoiseStyle::paper, .information = NoiseInformation::paper, .seed = 4});
  expect_distribution(
      values_of(loops, [&](const auto& loop) { return loop.information(0, 0) / mean(0, 0); }),
      uniform_cdf(-1.0, 3.0));
}

// Lengths of the runs of loops that follow each other at both ends.
template <class Loops>
std::vector<Index> group_sizes(const Loops& loops) {
  std::vector<Index> sizes;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto earlier = [&](std::size_t l) { return std::min(loops[l].from, loops[l].to); };
    const auto later = [&](std::size_t l) { return std::max(loops[l].from, loops[l].to); };
    const bool follows = k > 0 && earlier(k) == earlier(k - 1) + 1 && later(k) == later(k - 1) + 1;
    if (follows) {
      ++sizes.back();
    } else {
      sizes.push_back(1);
    }
  }
  sizes.pop_back();  // the last group may be cut off by the count
  return sizes;
}

TEST(CorruptStatistics, GroupsHaveTheSizesTheirTypeStates) {
  // A group ends early at the end of the path: at most a hundredth of them.
  const auto share = [](const std::vector<Index>& sizes, Index size) {
    return static_cast<double>(std::count(sizes.begin(), sizes.end(), size)) /
           static_cast<double>(sizes.size());
  };
  for (const auto type : {NoiseType::random_grouped, NoiseType::local_grouped}) {
    EXPECT_GT(share(group_sizes(injected(planar(), {.type = type})), 10), 0.97);
    EXPECT_GT(share(group_sizes(injected(planar(), {.style = NoiseStyle::paper, .type = type})), 5),
              0.97);
  }
  auto sizes =
      group_sizes(injected(planar(), {.style = NoiseStyle::paper, .type = NoiseType::all_random}));
  std::erase(sizes, 1);  // only cut off at the end of the path
  expect_uniform(sizes, 2, 7);
}

}  // namespace
}  // namespace isotherm::slam
