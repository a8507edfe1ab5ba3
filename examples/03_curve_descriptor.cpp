// Describes the local shape of a curve, and finds the place where the same bend
// is travelled again, the other way.
#include <cmath>
#include <cstdio>
#include <vector>

#include <isotherm/geometry.hpp>

int main() {
  using namespace isotherm::geometry;

  // Out along a bending road, a turning loop at its end, and back on the same road.
  std::vector<Eigen::Vector2d> points;
  const auto road = [](double x) { return Eigen::Vector2d(x, 4.0 * std::sin(0.002 * x * x)); };
  for (double x = 0.0; x < 60.0; x += 0.5) points.push_back(road(x));
  for (double a = 1.5; a > -1.5; a -= 0.2) {
    points.push_back(road(60.0) + 3.0 * Eigen::Vector2d(std::cos(a), std::sin(a)));
  }
  for (double x = 60.0; x > 0.0; x -= 0.7) points.push_back(road(x));
  const Polyline<2> path(points);

  const int vertex = 80;  // at x = 40
  const LapLineOptions options{.interval = 0.5};
  const auto described = lap_line(path, vertex, options);
  std::printf("%d samples from %.1f m behind to %.1f m ahead; offsets up to %.2f m\n",
              described.samples(), described.behind * described.interval,
              described.ahead * described.interval, described.offsets.cwiseAbs().maxCoeff());

  // The closest match on the way back, in reversed travel.
  int best = -1;
  double least = 1e9;
  for (int v = 140; v < static_cast<int>(points.size()) - 20; ++v) {
    const auto found = disparity(described, reversed(lap_line(path, v, options)));
    if (found.samples < 20 || found.rms >= least) continue;
    best = v;
    least = found.rms;
  }
  std::printf("best match on the way back at x = %.1f m: disparity %.3f m over the window\n",
              points[best].x(), least);
  return std::abs(points[best].x() - points[vertex].x()) < 1.0 ? 0 : 1;
}
