#include "isotherm/geometry/curves/polyline.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm::geometry {
namespace {

TEST(Polyline, ArcLengthsOfASquareWithARepeatedCorner) {
  const Polyline<2> line({{0, 0}, {2, 0}, {2, 0}, {2, 3}});
  EXPECT_THAT(line.arc_lengths(), testing::ElementsAre(0.0, 2.0, 2.0, 5.0));
  EXPECT_EQ(line.length(), 5.0);
}

TEST(Polyline, HelixLengthApproachesTheClosedForm) {
  std::vector<Eigen::Vector3d> points;
  const int n = 20000;
  for (int i = 0; i <= n; ++i) {
    const double t = 2.0 * std::numbers::pi * i / n;
    points.emplace_back(std::cos(t), std::sin(t), t);
  }
  // A chord is shorter than its arc by a relative (dt)^2 / 24 at most.
  const double expected = 2.0 * std::numbers::pi * std::numbers::sqrt2;
  EXPECT_NEAR(Polyline<3>(points).length(), expected, expected * 1e-8);
}

TEST(Polyline, FewerThanTwoPointsHaveNoLength) {
  EXPECT_EQ(Polyline<2>().length(), 0.0);
  EXPECT_EQ(Polyline<2>({{1, 1}}).length(), 0.0);
}

TEST(Polyline, PointsByArcLength) {
  const Polyline<2> line({{0, 0}, {2, 0}, {2, 0}, {2, 3}});
  EXPECT_EQ(line.at(-1.0), Eigen::Vector2d(0, 0));
  EXPECT_EQ(line.at(0.5), Eigen::Vector2d(0.5, 0));
  EXPECT_EQ(line.at(2.0), Eigen::Vector2d(2, 0));
  EXPECT_EQ(line.at(3.5), Eigen::Vector2d(2, 1.5));
  EXPECT_EQ(line.at(9.0), Eigen::Vector2d(2, 3));
  EXPECT_THROW(Polyline<3>().at(0.0), InvalidArgument);
}

TEST(Polyline, RejectsCoordinatesThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Polyline<2>({{0, 0}, {nan, 1}}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::geometry
