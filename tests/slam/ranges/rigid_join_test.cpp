#include "ranges/rigid_join.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace isotherm::slam::detail {
namespace {

template <class Pose>
typename Pose::Translation random_place(Random& random, double extent) {
  typename Pose::Translation place;
  for (auto& x : place) x = random.uniform(-extent, extent);
  return place;
}

template <class Pose>
std::vector<BodyRange<Pose>> ranges_between(const Pose& T_a_b, bool is_point, int count,
                                            double noise, Random& random) {
  std::vector<BodyRange<Pose>> ranges;
  for (int k = 0; k < count; ++k) {
    const auto a = random_place<Pose>(random, 10.0);
    typename Pose::Translation b = random_place<Pose>(random, 5.0);
    if (is_point) b.setZero();
    ranges.push_back({a, b, std::abs((a - T_a_b * b).norm() + random.normal(0.0, noise)), 0.05});
  }
  return ranges;
}

template <class Pose>
Pose somewhere(Random& random, bool is_point) {
  typename Pose::Tangent xi;
  for (auto& x : xi) x = random.uniform(-1.5, 1.5);
  xi.template head<Pose::kDim>() *= 5.0;
  if (is_point) xi.template tail<Pose::kDof - Pose::kDim>().setZero();
  return Pose::exp(xi);
}

template <class Pose>
void expect_found(bool is_point, int count) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Random random(seed);
    const Pose truth = somewhere<Pose>(random, is_point);
    auto ranges = ranges_between(truth, is_point, count, 0.0, random);
    for (std::size_t k = 0; k < ranges.size(); k += 4)
      ranges[k].distance = random.uniform(0.0, 20.0);
    const auto modes = join_modes(ranges, is_point, random);
    ASSERT_FALSE(modes.empty());
    EXPECT_LT((truth.inverse() * modes.front().T_a_b).log().norm(), 0.02) << seed;
    EXPECT_LT(modes.front().cost, unexplained_cost(ranges, 30.0));
  }
}

TEST(RigidJoin, BodiesAreFoundAmongFalseRanges) {
  expect_found<Pose2>(true, 20);
  expect_found<Pose3>(true, 24);
  expect_found<Pose2>(false, 40);
  expect_found<Pose3>(false, 80);
}

TEST(RigidJoin, TwoCirclesMeetTwice) {
  // From (0, 0) and (6, 0), both 5 away: (3, 4) and (3, -4).
  const std::vector<BodyRange<Pose2>> ranges = {{{0.0, 0.0}, {0.0, 0.0}, 5.0, 0.01},
                                                {{6.0, 0.0}, {0.0, 0.0}, 5.0, 0.01}};
  Random random(0);
  const auto modes = join_modes(ranges, true, random);
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_NEAR(modes[0].cost, modes[1].cost, 1e-3);
  for (const auto& mode : modes) {
    EXPECT_NEAR(mode.T_a_b.translation().x(), 3.0, 1e-4);
    EXPECT_NEAR(std::abs(mode.T_a_b.translation().y()), 4.0, 1e-4);
  }
}

TEST(RigidJoin, ThreeSpheresMeetTwice) {
  // Around the corners of a triangle in a plane, through (1, 1, 2).
  const Eigen::Vector3d place(1.0, 1.0, 2.0);
  std::vector<BodyRange<Pose3>> ranges;
  for (const Eigen::Vector3d& a :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(4, 0, 0), Eigen::Vector3d(0, 3, 0)}) {
    ranges.push_back({a, Eigen::Vector3d::Zero(), (place - a).norm(), 0.01});
  }
  Random random(0);
  const auto modes = join_modes(ranges, true, random);
  ASSERT_EQ(modes.size(), 2u);
  const Pose3 first = modes.front().T_a_b;
  EXPECT_NEAR(std::abs(first.translation().z()), 2.0, 1e-4);
  EXPECT_LT((mirror_image(ranges, first).translation() - modes[1].T_a_b.translation()).norm(),
            1e-3);
}

TEST(RigidJoin, TooLittleGivesNothing) {
  Random random(0);
  EXPECT_TRUE(join_modes(std::vector<BodyRange<Pose2>>{}, true, random).empty());
  EXPECT_TRUE(join_modes(std::vector<BodyRange<Pose2>>(1), true, random).empty());
  // All from one place: circles that do not meet in points.
  const std::vector<BodyRange<Pose2>> same(
      10, {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(), 2.0, 0.1});
  EXPECT_TRUE(join_modes(same, true, random).empty());
}

}  // namespace
}  // namespace isotherm::slam::detail
