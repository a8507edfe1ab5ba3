#include "isotherm/geometry/curves/curve_stretch.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/curves.hpp"
#include "isotherm/base/error.hpp"

namespace isotherm::geometry {
namespace {

Polyline<2> straight(double from, double to, double y) { return Polyline<2>({{from, y}, {to, y}}); }

TEST(StretchAround, PointsAtEqualStepsToEitherSide) {
  const auto stretch = stretch_around(straight(0.0, 10.0, 2.0), 4.0, 3.0, 0.5);
  EXPECT_EQ(stretch.behind, 6);
  EXPECT_EQ(stretch.ahead, 6);
  ASSERT_EQ(stretch.points.rows(), 13);
  for (int k = 0; k < 13; ++k) {
    EXPECT_DOUBLE_EQ(stretch.points(k, 0), 1.0 + 0.5 * k);
    EXPECT_DOUBLE_EQ(stretch.points(k, 1), 2.0);
  }
}

TEST(StretchAround, EndsWithTheCurve) {
  const auto stretch = stretch_around(straight(0.0, 10.0, 0.0), 9.2, 3.0, 1.0);
  EXPECT_EQ(stretch.behind, 3);
  EXPECT_EQ(stretch.ahead, 0);
  EXPECT_DOUBLE_EQ(stretch.points(3, 0), 9.2);
}

TEST(StretchAround, DoesNotDependOnHowTheCurveIsSampled) {
  const auto sine = [](double x) { return Eigen::Vector3d(x, std::sin(x), 0.3 * x); };
  const auto coarse = curves::sample<3>(sine, 0.0, 8.0, 2000);
  const auto fine = curves::sample<3>(sine, 0.0, 8.0, 8000);
  const auto a = stretch_around(coarse, coarse.arc_lengths()[1000], 2.0, 0.1);
  const auto b = stretch_around(fine, fine.arc_lengths()[4000], 2.0, 0.1);
  EXPECT_LT((a.points - b.points).abs().maxCoeff(), 1e-5);
}

TEST(Cropped, KeepsThePlace) {
  const auto whole = stretch_around(straight(0.0, 10.0, 0.0), 5.0, 4.0, 1.0);
  const auto part = cropped(whole, 1, 99);
  EXPECT_EQ(part.behind, 1);
  EXPECT_EQ(part.ahead, 4);
  EXPECT_EQ(part.points(0, 0), 4.0);
  EXPECT_EQ(cropped(whole, 0, 0).points.rows(), 1);
}

TEST(StretchGap, MeanDistanceOfEachHalf) {
  // The second half of `a` turns off at a right angle.
  const Polyline<2> turning({{-4, 0}, {0, 0}, {0, 4}});
  const auto a = stretch_around(turning, 4.0, 4.0, 1.0);
  const auto b = stretch_around(straight(-4.0, 4.0, 0.5), 4.0, 4.0, 1.0);
  const auto gap = stretch_gap(a, b, 2.0, 1);
  EXPECT_DOUBLE_EQ(gap.behind, 0.5);
  EXPECT_DOUBLE_EQ(gap.ahead, (0.5 + 1.5 + 2.0 + 2.0) / 4.0);  // two of them capped
  EXPECT_EQ(gap.least(), gap.behind);
  EXPECT_EQ(gap.greatest(), gap.ahead);
}

TEST(StretchGap, SenseOfTravelPlaysNoPart) {
  const auto there = stretch_around(straight(-5.0, 5.0, 0.0), 5.0, 5.0, 1.0);
  const auto back = stretch_around(straight(5.0, -5.0, 0.0), 5.0, 5.0, 1.0);
  EXPECT_EQ(stretch_gap(there, back, 1.0, 1).greatest(), 0.0);
}

TEST(StretchGap, HalvesThatAreTooShortAreNotKnown) {
  const auto a = stretch_around(straight(0.0, 10.0, 0.0), 1.0, 5.0, 1.0);
  const auto gap = stretch_gap(a, a, 1.0, 3);
  EXPECT_TRUE(std::isnan(gap.behind));
  EXPECT_EQ(gap.least(), 0.0);
  EXPECT_EQ(gap.greatest(), 0.0);
  EXPECT_TRUE(std::isnan(stretch_gap(a, a, 1.0, 99).least()));
}

TEST(CurveStretch, RejectsWhatMakesNoSense) {
  const auto line = straight(0.0, 10.0, 0.0);
  EXPECT_THROW(stretch_around(line, 1.0, 1.0, 0.0), InvalidArgument);
  EXPECT_THROW(stretch_around(line, 1.0, 1.0, 2.0), InvalidArgument);
  EXPECT_THROW(stretch_around(line, 1.0, std::nan(""), 1.0), InvalidArgument);
  EXPECT_THROW(stretch_around(Polyline<2>(), 0.0, 1.0, 1.0), InvalidArgument);
  const auto a = stretch_around(line, 1.0, 1.0, 1.0);
  EXPECT_THROW(stretch_gap(a, a, 0.0, 1), InvalidArgument);
  EXPECT_THROW(stretch_gap(a, a, 1.0, 0), InvalidArgument);
  EXPECT_THROW(stretch_gap(a, CurveStretch<2>(), 1.0, 1), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::geometry
