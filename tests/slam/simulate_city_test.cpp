#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/odometry.hpp"
#include "isotherm/slam/simulate.hpp"

namespace isotherm::slam {
namespace {

TEST(SimulateCity, HasTheSizeThatWasAskedFor) {
  const auto city = simulate_city({.poses = 2000, .loops = 700, .seed = 1});
  EXPECT_EQ(city.graph.vertex_count(), 2000);
  EXPECT_EQ(city.truth.size(), 2000u);
  const auto roles = edge_roles(city.graph);
  EXPECT_EQ(roles.odometry.size(), 1999u);
  EXPECT_EQ(roles.candidates.size(), 700u);
}

TEST(SimulateCity, TruthIsAWalkOfUnitSteps) {
  const auto city = simulate_city({.poses = 500, .seed = 2});
  EXPECT_LT(city.truth.front().log().norm(), 1e-15);
  for (std::size_t k = 1; k < city.truth.size(); ++k) {
    const auto step = city.truth[k].translation() - city.truth[k - 1].translation();
    EXPECT_NEAR(step.norm(), 1.0, 1e-12);
    const double turn = wrap_angle(city.truth[k].angle() - city.truth[k - 1].angle());
    EXPECT_LT(std::abs(turn), 1.6) << "the robot never turns back on the spot";
  }
}

TEST(SimulateCity, MeasurementsHaveTheNoiseTheirInformationStates) {
  const auto city = simulate_city({.poses = 4000, .loops = 2000, .drift = 8.0, .seed = 3});
  double chi2 = 0.0;
  for (const auto& constraint : city.graph.constraints) {
    const auto r = residual(constraint, city.truth[constraint.from], city.truth[constraint.to]);
    chi2 += r.dot(constraint.information * r);
  }
  // Mean 3 and variance 6 a constraint.
  const auto m = static_cast<double>(city.graph.constraints.size());
  EXPECT_NEAR(chi2, 3.0 * m, 5.0 * std::sqrt(6.0 * m));
}

TEST(SimulateCity, LoopsJoinCloseDistantInTimePosesOnce) {
  const auto city = simulate_city({.poses = 3000, .loops = 1500, .loop_radius = 1.0, .seed = 4});
  std::vector<std::pair<Index, Index>> pairs;
  for (const Index k : edge_roles(city.graph).candidates) {
    const auto& loop = city.graph.constraints[k];
    EXPECT_GE(loop.to - loop.from, 10);
    EXPECT_LT((city.truth[loop.from].translation() - city.truth[loop.to].translation()).norm(),
              1.0 + 1e-9);
    pairs.emplace_back(loop.from, loop.to);
  }
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

TEST(SimulateCity, DriftIsWhatWasAskedFor) {
  for (const double drift : {5.0, 20.0, 40.0}) {
    const auto city = simulate_city({.poses = 3500, .drift = drift, .seed = 5});
    const auto& end = city.graph.poses.back();
    EXPECT_NEAR((end.translation() - city.truth.back().translation()).norm(), drift, 1e-6 * drift);
  }
}

TEST(SimulateCity, RepeatsWithTheSeed) {
  const auto a = simulate_city({.poses = 300, .seed = 6});
  const auto b = simulate_city({.poses = 300, .seed = 6});
  const auto c = simulate_city({.poses = 300, .seed = 7});
  ASSERT_EQ(a.graph.constraint_count(), b.graph.constraint_count());
  for (Index k = 0; k < a.graph.constraint_count(); ++k) {
    EXPECT_EQ(a.graph.constraints[k].T_from_to.translation(),
              b.graph.constraints[k].T_from_to.translation());
  }
  EXPECT_NE(a.graph.poses.back().translation(), c.graph.poses.back().translation());
}

TEST(SimulateCity, SmallestGraphsAndImpossibleWishes) {
  EXPECT_EQ(simulate_city({.poses = 1}).graph.constraint_count(), 0);
  EXPECT_EQ(simulate_city({.poses = 2, .loops = 10}).graph.constraint_count(), 1)
      << "no pair is far enough apart for a loop";
  EXPECT_THROW(simulate_city({.poses = 0}), InvalidArgument);
  EXPECT_THROW(simulate_city({.block = 0}), InvalidArgument);
  EXPECT_THROW(simulate_city({.odometry_sigma = 0.0}), InvalidArgument);
  EXPECT_THROW(simulate_city({.drift = -1.0}), InvalidArgument);
  EXPECT_THROW(simulate_city({.poses = 1, .drift = 5.0}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
