#include "isotherm/network/simulate/simulate_network.hpp"

#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm::network {
namespace {

double true_distance(const SimulatedNetwork& simulated, const RangeMeasurement& range) {
  return (simulated.truth.col(range.from) - simulated.truth.col(range.to)).norm();
}

TEST(SimulateNetwork, MeasuresExactlyTheNeighbours) {
  for (const int dimension : {2, 3}) {
    const auto simulated = simulate_network(
        {.nodes = 300, .dimension = dimension, .anchors = 7, .noise = 0.0, .seed = 1});
    std::set<std::pair<Index, Index>> measured;
    for (const auto& range : simulated.network.ranges) {
      EXPECT_EQ(range.distance, true_distance(simulated, range));
      EXPECT_LE(range.distance, simulated.radius);
      EXPECT_TRUE(measured.insert(std::minmax(range.from, range.to)).second);
    }
    std::size_t expected = 0;
    for (Index a = 0; a < 300; ++a) {
      for (Index b = a + 1; b < 300; ++b) {
        if ((simulated.truth.col(a) - simulated.truth.col(b)).norm() <= simulated.radius) {
          ++expected;
        }
      }
    }
    EXPECT_EQ(measured.size(), expected);
    EXPECT_EQ(simulated.network.landmarks.size(), 7u);
  }
}

TEST(SimulateNetwork, NoiseBiasAndFalseRangesAreAsAskedFor) {
  const auto simulated = simulate_network(
      {.nodes = 2000, .noise = 0.1, .false_fraction = 0.2, .biased_fraction = 0.1, .seed = 9});
  const auto& ranges = simulated.network.ranges;
  double squares = 0.0;
  double measured = 0.0;
  double biased = 0.0;
  double invented = 0.0;
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const double distance = true_distance(simulated, ranges[k]);
    switch (simulated.origins[k]) {
      case RangeOrigin::measured:
        squares += std::pow(ranges[k].distance - distance, 2) / ranges[k].variance;
        EXPECT_NEAR(std::sqrt(ranges[k].variance), 0.1 * distance, 1e-12);
        ++measured;
        break;
      case RangeOrigin::biased:
        EXPECT_GT(ranges[k].distance, distance - 0.5 * simulated.radius);
        ++biased;
        break;
      case RangeOrigin::invented:
        EXPECT_GT(distance, simulated.radius);
        EXPECT_LE(ranges[k].distance, simulated.radius);
        ++invented;
        break;
    }
  }
  const auto all = static_cast<double>(ranges.size());
  EXPECT_NEAR(biased / all, 0.1, 1e-3);
  EXPECT_NEAR(invented / all, 0.2, 1e-3);
  EXPECT_NEAR(squares / measured, 1.0, 0.05);
}

TEST(SimulateNetwork, RejectsOptionsOutOfRange) {
  EXPECT_THROW(simulate_network({.nodes = 1}), InvalidArgument);
  EXPECT_THROW(simulate_network({.dimension = 4}), InvalidArgument);
  EXPECT_THROW(simulate_network({.nodes = 10, .anchors = 11}), InvalidArgument);
  EXPECT_THROW(simulate_network({.degree = 0.0}), InvalidArgument);
  EXPECT_THROW(simulate_network({.radius = -1.0}), InvalidArgument);
  EXPECT_THROW(simulate_network({.noise = 0.5}), InvalidArgument);
  EXPECT_THROW(simulate_network({.false_fraction = 1.0}), InvalidArgument);
  EXPECT_THROW(simulate_network({.false_fraction = 0.6, .biased_fraction = 0.6}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::network
