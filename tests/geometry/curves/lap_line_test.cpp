#include "isotherm/geometry/curves/lap_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "geometry/curves.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

template <int Dim>
double largest_difference(const CurveDescriptor<Dim>& a, const CurveDescriptor<Dim>& b) {
  if (a.behind != b.behind || a.ahead != b.ahead) return std::numeric_limits<double>::infinity();
  return (a.offsets - b.offsets).cwiseAbs().maxCoeff();
}

Vector2d sine(double x) { return {x, 0.8 * std::sin(x)}; }

// What lap_line gives on the sine itself, from its arc length and slope.
std::vector<double> sine_offsets(double x0, double interval, double half_window) {
  const auto speed = [](double x) { return std::hypot(1.0, 0.8 * std::cos(x)); };
  const auto arc = [&](double x) { return curves::integrate(speed, x0, x); };
  const double front = curves::solve(arc, half_window, x0, x0 + 3.0);
  const double back = curves::solve(arc, -half_window, x0 - 3.0, x0);
  const Vector2d u = (sine(front) - sine(back)).normalized();
  const auto along = [&](double x) { return u.dot(sine(x) - sine(x0)); };
  std::vector<double> offsets;
  for (int k = static_cast<int>(std::ceil(along(back) / interval)); k * interval <= along(front);
       ++k) {
    const Vector2d p = sine(curves::solve(along, k * interval, back, front)) - sine(x0);
    offsets.push_back(u.x() * p.y() - u.y() * p.x());
  }
  return offsets;
}

TEST(LapLine, StraightLineHasNoOffsets) {
  const auto line =
      curves::sample<2>([](double t) { return Vector2d(3.0 * t, -4.0 * t); }, 0.0, 20.0, 100);
  const auto descriptor = lap_line(line, 50);
  EXPECT_DOUBLE_EQ(descriptor.interval, 1.0);
  EXPECT_EQ(descriptor.behind, 15);
  EXPECT_EQ(descriptor.ahead, 15);
  EXPECT_LT((descriptor.direction - Vector2d(0.6, -0.8)).norm(), 1e-12);
  EXPECT_LT(descriptor.offsets.cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LapLine, CircleEqualsTheClosedForm) {
  const double radius = 10.0;
  const auto circle = curves::sample<2>(
      [&](double t) { return Vector2d(radius * std::cos(t), radius * std::sin(t)); }, -0.4, 0.4,
      80000);
  const double interval = 0.2;
  const auto descriptor = lap_line(circle, 40000, {.interval = interval});
  // The line is the tangent; the circle lies to the left of its travel.
  const int expected = static_cast<int>(std::floor(radius * std::sin(3.0 / radius) / interval));
  ASSERT_EQ(descriptor.behind, expected);
  ASSERT_EQ(descriptor.ahead, expected);
  for (int k = -expected; k <= expected; ++k) {
    const double x = k * interval;
    EXPECT_NEAR(descriptor.offsets(expected + k), radius - std::sqrt(radius * radius - x * x),
                1e-9);
  }
}

TEST(LapLine, WindowStopsWhereTheCircleTurnsTooMuch) {
  const auto circle = curves::sample<2>([](double t) { return Vector2d(std::cos(t), std::sin(t)); },
                                        -2.0, 2.0, 200000);
  // After n intervals of 0.1 either way the chords span (2n - 1) 0.1 rad: n = 8 is
  // the last with at most pi / 2. Perpendiculars then reach sin(0.8) = 0.717.
  const auto descriptor = lap_line(circle, 100000, {.interval = 0.1});
  ASSERT_EQ(descriptor.behind, 7);
  ASSERT_EQ(descriptor.ahead, 7);
  for (int k = -7; k <= 7; ++k) {
    EXPECT_NEAR(descriptor.offsets(7 + k), 1.0 - std::sqrt(1.0 - 0.01 * k * k), 1e-9);
  }
}

TEST(LapLine, SineEqualsTheClosedForm) {
  const double x0 = 0.3;
  const auto path = curves::sample<2>(sine, x0 - 2.0, x0 + 2.0, 400000);
  const auto descriptor = lap_line(path, 200000, {.interval = 0.05});
  const auto expected = sine_offsets(x0, 0.05, 0.75);
  ASSERT_EQ(descriptor.samples(), static_cast<int>(expected.size()));
  for (int k = 0; k < descriptor.samples(); ++k) {
    EXPECT_NEAR(descriptor.offsets(k), expected[k], 1e-9);
  }
}

TEST(LapLine, HelixEqualsTheClosedForm) {
  const double radius = 2.0;
  const double pitch = 0.7;  // metres along the axis per radian
  const auto helix = [&](double t) {
    return Vector3d(radius * std::cos(t), radius * std::sin(t), pitch * t);
  };
  const auto path = curves::sample<3>(helix, -0.7, 0.7, 140000);
  const double interval = 0.08;
  const auto descriptor = lap_line(path, 70000, {.interval = interval});

  // Symmetric about the vertex: the chord lies in the tangent plane of the
  // cylinder, and the offset splits into an even part (towards the axis: within
  // the best plane) and an odd part (out of it).
  const double end = 15.0 * interval / std::hypot(radius, pitch);
  const Vector3d u = (helix(end) - helix(-end)).normalized();
  const Vector3d inwards = -Vector3d::UnitX();
  const Vector3d out = u.cross(inwards);
  const auto along = [&](double t) { return u.dot(helix(t) - helix(0.0)); };
  const int count = static_cast<int>(std::floor(along(end) / interval));
  ASSERT_EQ(descriptor.behind, count);
  ASSERT_EQ(descriptor.ahead, count);
  for (int k = -count; k <= count; ++k) {
    const Vector3d p = helix(curves::solve(along, k * interval, -end, end)) - helix(0.0);
    EXPECT_NEAR(descriptor.offsets(0, count + k), inwards.dot(p), 1e-9);
    EXPECT_NEAR(descriptor.offsets(1, count + k), out.dot(p), 1e-9);
  }
}

TEST(LapLine, ResamplingChangesNoMoreThanTheInterpolationBound) {
  const double x0 = 0.3;
  const double interval = 0.05;
  const double half_window = 15 * interval;
  const auto expected = sine_offsets(x0, interval, half_window);
  double previous = 0.0;
  for (const int count : {80, 160, 320, 640}) {
    const double h = 4.0 / count * std::hypot(1.0, 0.8);  // longest arc between vertices
    const auto path = curves::sample<2>(sine, x0 - 2.0, x0 + 2.0, count);
    const auto descriptor = lap_line(path, count / 2, {.interval = interval});
    ASSERT_EQ(descriptor.samples(), static_cast<int>(expected.size()));
    double error = 0.0;
    for (int k = 0; k < descriptor.samples(); ++k) {
      error = std::max(error, std::abs(descriptor.offsets(k) - expected[k]));
    }
    // With curvature at most 0.8: a chord is off its arc by kappa h^2 / 8 and short
    // of it by a share kappa^2 h^2 / 24, so an end of the window moves by at most
    // their sum, the line turns by twice that over its chord, and an offset
    // changes by the path's own error plus what the turn adds at its distance.
    const double kappa = 0.8;
    const double off = kappa * h * h / 8.0;
    const double end_moves = off + half_window * kappa * kappa * h * h / 24.0;
    const double turn = 2.0 * end_moves / (2.0 * half_window * std::cos(0.5));
    EXPECT_LE(error, (off + half_window * turn) / std::cos(0.5)) << count;
    if (previous > 0.0) {
      EXPECT_LT(error, 0.4 * previous) << count;  // second order
    }
    previous = error;
  }
}

TEST(LapLine, VerticesInsertedOnThePathChangeNothing) {
  Random random(5);
  std::vector<Vector2d> points = {{0.0, 0.0}};
  for (int k = 0; k < 40; ++k) {
    const double heading = 0.6 * std::sin(0.3 * k) + 0.1 * random.normal();
    points.push_back(points.back() + Vector2d(std::cos(heading), std::sin(heading)));
  }
  std::vector<Vector2d> denser;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    for (const double share : {0.0, 0.13, 0.5, 0.98}) {
      denser.push_back(points[k] + share * (points[k + 1] - points[k]));
    }
    denser.push_back(points[k + 1]);  // and repeated vertices
  }
  const LapLineOptions options{.interval = 0.7, .window = 20};
  for (int k = 0; k < 40; ++k) {
    const auto sparse = lap_line(Polyline<2>(points), k, options);
    const auto dense = lap_line(Polyline<2>(denser), 5 * k, options);
    EXPECT_LT(largest_difference(sparse, dense), 1e-12) << k;
  }
}

// A bending, twisting path with irregular steps.
Polyline<3> wandering_path(std::uint64_t seed) {
  Random random(seed);
  std::vector<Vector3d> points = {{0.0, 0.0, 0.0}};
  double yaw = 0.0;
  double climb = 0.0;
  for (int k = 0; k < 120; ++k) {
    yaw += 0.08 * random.normal();
    climb = 0.9 * climb + 0.05 * random.normal();
    const double step = random.uniform(0.5, 1.5);
    points.push_back(points.back() + step * Vector3d(std::cos(yaw), std::sin(yaw), climb));
  }
  return Polyline<3>(std::move(points));
}

Polyline<2> seen_from_above(const Polyline<3>& path) {
  std::vector<Vector2d> points;
  for (const auto& p : path.points()) points.push_back(p.head<2>());
  return Polyline<2>(std::move(points));
}

template <int Dim>
Polyline<Dim> backwards(const Polyline<Dim>& path) {
  auto points = path.points();
  std::reverse(points.begin(), points.end());
  return Polyline<Dim>(std::move(points));
}

TEST(LapLine, RigidMotionsChangeNothing) {
  const auto path3 = wandering_path(11);
  const auto path2 = seen_from_above(path3);
  const Eigen::Rotation2Dd turn(2.1);
  const Eigen::Quaterniond spin = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
  std::vector<Vector2d> moved2;
  std::vector<Vector3d> moved3;
  for (const auto& p : path2.points()) moved2.push_back(turn * p + Vector2d(4e5, -5e6));
  for (const auto& p : path3.points()) moved3.push_back(spin * p + Vector3d(4e5, -5e6, 300.0));
  for (int k = 0; k <= 120; k += 7) {
    const LapLineOptions options{.interval = 1.0};
    const auto a2 = lap_line(path2, k, options);
    const auto b2 = lap_line(Polyline<2>(moved2), k, options);
    EXPECT_LT(largest_difference(a2, b2), 1e-6) << k;  // 1e-9 of the coordinates is lost
    const auto a3 = lap_line(path3, k, options);
    const auto b3 = lap_line(Polyline<3>(moved3), k, options);
    EXPECT_LT(disparity(a3, b3).rms, 1e-6) << k;
    EXPECT_EQ(disparity(a3, b3).samples, a3.samples()) << k;
  }
}

TEST(LapLine, TravelTheOtherWayGivesTheReversedDescriptor) {
  const auto path3 = wandering_path(12);
  const auto path2 = seen_from_above(path3);
  for (int k = 0; k <= 120; k += 5) {
    const LapLineOptions options{.interval = 0.8};
    const auto there2 = reversed(lap_line(path2, k, options));
    const auto back2 = lap_line(backwards(path2), 120 - k, options);
    EXPECT_LT(largest_difference(there2, back2), 1e-10) << k;
    EXPECT_LT((there2.direction - back2.direction).norm(), 1e-12) << k;
    const auto there3 = reversed(lap_line(path3, k, options));
    const auto back3 = lap_line(backwards(path3), 120 - k, options);
    EXPECT_EQ(there3.samples(), disparity(there3, back3).samples) << k;
    EXPECT_LT(disparity(there3, back3).rms, 1e-9) << k;
  }
}

TEST(LapLine, NoiseOfAHundredthOfTheIntervalMovesOffsetsByAsMuch) {
  Random random(3);
  const double noise = 0.01;
  std::vector<Vector2d> clean;
  std::vector<Vector2d> noisy;
  for (int k = 0; k <= 200; ++k) {
    clean.push_back(Vector2d(k, 5.0 * std::sin(0.05 * k)));
    noisy.push_back(clean.back() + noise * Vector2d(random.normal(), random.normal()));
  }
  double squared = 0.0;
  int samples = 0;
  for (int k = 20; k <= 180; k += 4) {
    const LapLineOptions options{.interval = 1.0};
    const auto difference = disparity(lap_line(Polyline<2>(clean), k, options),
                                      lap_line(Polyline<2>(noisy), k, options));
    squared += difference.rms * difference.rms * difference.samples;
    samples += difference.samples;
  }
  // The path's own noise, the vertex's, and the line's tilt: about 1.5 deviations.
  EXPECT_LT(std::sqrt(squared / samples), 2.0 * noise);
  EXPECT_GT(std::sqrt(squared / samples), noise);
}

TEST(LapLine, TheFirstCrossingOfAPerpendicularCounts) {
  // The path steps back across x = 2 twice; the first crossing is on the way out.
  const Polyline<2> path({{0, 0}, {1, 0}, {2.2, 0.12}, {1.9, 0.3}, {3, 0.3}, {4, 0}, {5, 0}});
  const auto descriptor = lap_line(path, 0, {.interval = 1.0, .window = 6});
  ASSERT_GE(descriptor.ahead, 2);
  const Vector2d u = descriptor.direction;
  // On the first segment that reaches the perpendicular.
  const Vector2d a(1.0, 0.0);
  const Vector2d b(2.2, 0.12);
  const Vector2d crossing = a + (2.0 - u.dot(a)) / u.dot(b - a) * (b - a);
  EXPECT_NEAR(descriptor.offsets(2), u.x() * crossing.y() - u.y() * crossing.x(), 1e-12);
}

TEST(LapLine, ACornerOfARightAngleStaysInTheWindowASharperOneDoesNot) {
  const auto path_with_corner = [](double turn) {
    std::vector<Vector2d> points;
    for (int k = -20; k <= 0; ++k) points.emplace_back(k, 0.0);
    for (int k = 1; k <= 20; ++k) points.emplace_back(k * std::cos(turn), k * std::sin(turn));
    return Polyline<2>(std::move(points));
  };
  const LapLineOptions options{.interval = 1.0, .window = 10};
  const auto right = lap_line(path_with_corner(kPi / 2.0), 18, options);
  // Back 5 before the vertex, front 3 past the corner.
  EXPECT_LT((right.direction - Vector2d(7.0, 3.0).normalized()).norm(), 1e-12);
  const auto sharp = lap_line(path_with_corner(2.0), 18, options);
  EXPECT_EQ(sharp.ahead, 2);
  EXPECT_EQ(sharp.behind, 2);
  EXPECT_LT(sharp.offsets.norm(), 1e-12);
}

TEST(LapLine, EndsOfThePolylineHaveOneSidedWindows) {
  const auto path = curves::sample<2>(sine, 0.0, 3.0, 60);
  const auto first = lap_line(path, 0, {.interval = 0.1, .window = 10});
  EXPECT_EQ(first.behind, 0);
  EXPECT_GT(first.ahead, 3);
  const auto last = lap_line(path, 60, {.interval = 0.1, .window = 10});
  EXPECT_EQ(last.ahead, 0);
  EXPECT_GT(last.behind, 3);
  EXPECT_EQ(disparity(first, last).samples, 1);
  EXPECT_EQ(disparity(first, last).rms, 0.0);
}

TEST(LapLine, WithoutLengthOnlyTheVertexIsDescribed) {
  for (const auto& path :
       {Polyline<2>({{1, 1}}), Polyline<2>({{1, 1}, {1, 1}, {1, 1}}),
        // Returns to where it was within every interval.
        Polyline<2>({{0, 0}, {0.5, 0}, {0, 0}, {0.5, 0}, {0, 0}, {0.5, 0}, {0, 0}})}) {
    const int middle = static_cast<int>(path.points().size()) / 2;
    const LapLineOptions options{.interval = path.length() > 0.0 ? 1.0 : 0.0};
    const auto descriptor = lap_line(path, middle - middle % 2, options);
    EXPECT_EQ(descriptor.samples(), 1);
    EXPECT_EQ(descriptor.direction, Vector2d::Zero());
    EXPECT_EQ(descriptor.offsets.cols(), 1);
  }
}

TEST(LapLine, APlanarCurveInSpaceHasNothingOutOfItsPlane) {
  const auto path2 = seen_from_above(wandering_path(13));
  const Eigen::Quaterniond spin = Eigen::Quaterniond(0.9, 0.1, -0.4, 0.3).normalized();
  std::vector<Vector3d> points;
  for (const auto& p : path2.points()) points.push_back(spin * Vector3d(p.x(), p.y(), 0.0));
  const Polyline<3> path3(points);
  for (int k = 0; k <= 120; k += 9) {
    const auto flat = lap_line(path2, k);
    const auto spatial = lap_line(path3, k);
    ASSERT_EQ(flat.samples(), spatial.samples());
    EXPECT_LT(spatial.offsets.row(1).cwiseAbs().maxCoeff(), 1e-9) << k;
    EXPECT_NEAR(spatial.offsets.row(0).norm(), flat.offsets.norm(), 1e-9) << k;
  }
}

TEST(LapLine, AMirroredHelixIsAnotherCurve) {
  const auto helix = [](double handedness) {
    return curves::sample<3>(
        [=](double t) { return Vector3d(std::cos(t), handedness * std::sin(t), 0.8 * t); }, -2.0,
        2.0, 400);
  };
  const LapLineOptions options{.interval = 0.05};
  const auto right = lap_line(helix(1.0), 200, options);
  EXPECT_LT(disparity(right, lap_line(helix(1.0), 150, options)).rms, 1e-6);
  EXPECT_LT(disparity(right, reversed(right)).rms, 1e-6);  // a screw looks alike both ways
  EXPECT_GT(disparity(right, lap_line(helix(-1.0), 200, options)).rms, 1e-3);
}

TEST(LapLine, ManyDescriptorsEqualSingleOnesForAnyNumberOfThreads) {
  const auto path = seen_from_above(wandering_path(14));
  std::vector<int> vertices;
  for (int k = 0; k <= 120; ++k) vertices.push_back((k * 37) % 121);
  const auto one = lap_lines(path, vertices, {}, 1);
  const auto four = lap_lines(path, vertices, {}, 4);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const auto single = lap_line(path, vertices[k]);
    EXPECT_EQ(single.offsets, one[k].offsets);
    EXPECT_EQ(single.offsets, four[k].offsets);
  }
  EXPECT_THROW(lap_lines(path, vertices, {}, 1, [](const Progress&) { return false; }), Cancelled);
}

TEST(LapLine, RejectsWhatItCannotDescribe) {
  const Polyline<2> path({{0, 0}, {1, 0}});
  EXPECT_THROW(lap_line(path, -1), InvalidArgument);
  EXPECT_THROW(lap_line(path, 2), InvalidArgument);
  EXPECT_THROW(lap_line(Polyline<3>(), 0), InvalidArgument);
  EXPECT_THROW(lap_line(path, 0, {.interval = -1.0}), InvalidArgument);
  EXPECT_THROW(lap_line(path, 0, {.window = 3}), InvalidArgument);
  EXPECT_THROW(lap_line(path, 0, {.max_turn = 2.0}), InvalidArgument);
  EXPECT_THROW(lap_lines(path, {0}, {}, -1), InvalidArgument);
  EXPECT_THROW(disparity(lap_line(path, 0), lap_line(path, 0, {.interval = 0.5})), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::geometry
