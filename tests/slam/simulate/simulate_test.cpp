#include "isotherm/slam/simulate/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/odometry.hpp"

namespace isotherm::slam {
namespace {

// One entry a world, so that what holds in all of them is tested once.
struct City {
  using Options = CityOptions;
  static auto simulate(const Options& options) { return simulate_city(options); }
};
struct Grid3d {
  using Options = Grid3dOptions;
  static auto simulate(const Options& options) { return simulate_grid3d(options); }
};
struct Ring {
  using Options = RingOptions;
  static auto simulate(const Options& options) { return simulate_ring(options); }
};
struct Sphere {
  using Options = SphereOptions;
  static auto simulate(const Options& options) { return simulate_sphere(options); }
};

template <class World>
class SimulatedWorld : public ::testing::Test {
 protected:
  using Options = typename World::Options;

  static Options options(std::int64_t poses, const MeasurementOptions& measurements,
                         std::uint64_t seed) {
    Options result;
    result.poses = poses;
    result.measurements = measurements;
    result.seed = seed;
    return result;
  }

  static auto simulate(std::int64_t poses, const MeasurementOptions& measurements = {},
                       std::uint64_t seed = 1) {
    return World::simulate(options(poses, measurements, seed));
  }
};

using Worlds = ::testing::Types<City, Grid3d, Ring, Sphere>;
TYPED_TEST_SUITE(SimulatedWorld, Worlds);

TYPED_TEST(SimulatedWorld, HasTheSizeThatWasAskedFor) {
  const auto world = this->simulate(2000, {.loops = 700});
  EXPECT_EQ(world.graph.vertex_count(), 2000);
  EXPECT_EQ(world.truth.size(), 2000u);
  const auto roles = edge_roles(world.graph);
  EXPECT_EQ(roles.odometry.size(), 1999u);
  EXPECT_EQ(roles.candidates.size(), 700u);
}

TYPED_TEST(SimulatedWorld, StartsAtTheIdentity) {
  EXPECT_LT(this->simulate(50).truth.front().log().norm(), 1e-15);
}

TYPED_TEST(SimulatedWorld, MeasurementsHaveTheNoiseTheirInformationStates) {
  const auto world = this->simulate(4000, {.loops = 2000, .drift = 8.0}, 3);
  double chi2 = 0.0;
  double entries = 0.0;
  for (const auto& constraint : world.graph.constraints) {
    const auto r = residual(constraint, world.truth[constraint.from], world.truth[constraint.to]);
    chi2 += r.dot(constraint.information * r);
    entries += static_cast<double>(r.size());
  }
  EXPECT_NEAR(chi2, entries, 5.0 * std::sqrt(2.0 * entries)) << "mean 1, variance 2 an entry";
}

TYPED_TEST(SimulatedWorld, LoopsJoinCloseDistantInTimePosesOnce) {
  const auto world = this->simulate(3000, {.loops = 1500, .loop_radius = 1.1}, 4);
  std::vector<std::pair<Index, Index>> pairs;
  for (const Index k : edge_roles(world.graph).candidates) {
    const auto& loop = world.graph.constraints[k];
    EXPECT_GE(loop.to - loop.from, 10);
    EXPECT_LT((world.truth[loop.from].translation() - world.truth[loop.to].translation()).norm(),
              1.1 + 1e-6);
    pairs.emplace_back(loop.from, loop.to);
  }
  EXPECT_GT(pairs.size(), 500u);
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

TYPED_TEST(SimulatedWorld, DriftIsWhatWasAskedFor) {
  for (const double drift : {5.0, 20.0}) {
    const auto world = this->simulate(2500, {.drift = drift}, 5);
    const auto& end = world.graph.poses.back();
    EXPECT_NEAR((end.translation() - world.truth.back().translation()).norm(), drift, 1e-6 * drift);
  }
}

TYPED_TEST(SimulatedWorld, RepeatsWithTheSeed) {
  const auto a = this->simulate(300, {}, 6);
  const auto b = this->simulate(300, {}, 6);
  const auto c = this->simulate(300, {}, 7);
  ASSERT_EQ(a.graph.constraint_count(), b.graph.constraint_count());
  for (Index k = 0; k < a.graph.constraint_count(); ++k) {
    EXPECT_EQ(a.graph.constraints[k].T_from_to.translation(),
              b.graph.constraints[k].T_from_to.translation());
  }
  EXPECT_NE(a.graph.poses.back().translation(), c.graph.poses.back().translation());
}

TYPED_TEST(SimulatedWorld, SmallestGraphsAndImpossibleWishes) {
  EXPECT_EQ(this->simulate(1).graph.constraint_count(), 0);
  EXPECT_EQ(this->simulate(2, {.loops = 10}).graph.constraint_count(), 1)
      << "no pair is far enough apart for a loop";
  EXPECT_THROW(this->simulate(0), InvalidArgument);
  EXPECT_THROW(this->simulate(10, {.loops = -2}), InvalidArgument);
  EXPECT_THROW(this->simulate(10, {.odometry_sigma = 0.0}), InvalidArgument);
  EXPECT_THROW(this->simulate(10, {.loop_radius = std::nan("")}), InvalidArgument);
  EXPECT_THROW(this->simulate(10, {.drift = -1.0}), InvalidArgument);
  EXPECT_THROW(this->simulate(1, {.drift = 5.0}), InvalidArgument);
}

template <class Pose>
void expect_unit_steps(const std::vector<Pose>& truth) {
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const Pose step = truth[k - 1].inverse() * truth[k];
    EXPECT_NEAR(step.translation().norm(), 1.0, 1e-12);
    EXPECT_LT(step.rotation_angle(), 1.6) << "no vehicle turns back on the spot";
    EXPECT_NEAR(step.translation()[0], 1.0, 1e-12) << "it moves the way it looks";
  }
}

TEST(SimulateCity, TruthIsAWalkOfUnitSteps) {
  expect_unit_steps(simulate_city({.poses = 500, .seed = 2}).truth);
}

TEST(SimulateGrid3d, TruthIsAWalkOfUnitStepsInThreeDimensions) {
  const auto truth = simulate_grid3d({.poses = 2000, .seed = 2}).truth;
  expect_unit_steps(truth);
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::minmax_element(truth.begin(), truth.end(), [axis](const Pose3& a, const Pose3& b) {
          return a.translation()[axis] < b.translation()[axis];
        });
    EXPECT_GT(high->translation()[axis] - low->translation()[axis], 5.0);
  }
}

TEST(SimulateRing, LapsMeetAfterTheCircumference) {
  const auto truth = simulate_ring({.poses = 900, .laps = 3}).truth;
  EXPECT_LT((truth[0].inverse() * truth[300]).log().norm(), 1e-9);
  EXPECT_LT((truth[100].inverse() * truth[700]).log().norm(), 1e-9);
  const double diameter = 300.0 / 3.141592653589793;
  EXPECT_NEAR((truth[0].translation() - truth[150].translation()).norm(), diameter, 1e-9);
}

TEST(SimulateSphere, StaysOnASphereLevelWithItsSurface) {
  const auto truth = simulate_sphere({.poses = 2500}).truth;
  // laps = round(sqrt(2500 pi) / 2) = 44, radius = 2500 / (4 * 44).
  const double radius = 2500.0 / 176.0;
  const Pose3::Translation centre = -radius * Pose3::Translation::UnitZ();
  for (const auto& pose : truth) {
    const Pose3::Translation up = (pose.translation() - centre) / radius;
    EXPECT_NEAR(up.norm(), 1.0, 1e-9);
    EXPECT_LT((pose.rotation_matrix().col(2) - up).norm(), 1e-9);
  }
}

TEST(Simulate, RefusesShapesThatAreNone) {
  EXPECT_THROW(simulate_city({.block = 0}), InvalidArgument);
  EXPECT_THROW(simulate_grid3d({.block = -1}), InvalidArgument);
  EXPECT_THROW(simulate_ring({.laps = 0}), InvalidArgument);
  EXPECT_THROW(simulate_sphere({.laps = -1}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
