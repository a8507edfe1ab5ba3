#include "isotherm/geometry/curves/lap_line.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Geometry>

#include "curves/perpendicular.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/parallel.hpp"

namespace isotherm::geometry {
namespace {

// A sample that rounding puts this share of an interval beyond the window counts.
constexpr double kRounding = 1e-9;

// The part of the path that is described: whole intervals of arc length to either
// side of the vertex.
template <int Dim>
struct Window {
  using Point = typename Polyline<Dim>::Point;
  int behind = 0;
  int ahead = 0;
  Point back;   // the paper's v_b
  Point front;  // the paper's v_f
};

template <int Dim>
class WindowGrower {
 public:
  using Point = typename Polyline<Dim>::Point;

  WindowGrower(const Polyline<Dim>& polyline, int vertex, double interval,
               const LapLineOptions& options)
      : polyline_(polyline),
        start_(polyline.arc_lengths()[vertex]),
        interval_(interval),
        least_cosine_(std::cos(options.max_turn) - kRounding),
        half_(options.window / 2) {
    window_.back = window_.front = polyline.points()[vertex];
    directions_.reserve(options.window);
  }

  Window<Dim> grow() && {
    for (int step = 1; step <= half_; ++step) {
      const double arc = step * interval_;
      const bool can_ahead = start_ + arc <= polyline_.length() + kRounding * interval_;
      const bool can_behind = start_ - arc >= -kRounding * interval_;
      const Point front = can_ahead ? polyline_.at(start_ + arc) : window_.front;
      const Point back = can_behind ? polyline_.at(start_ - arc) : window_.back;
      if (can_ahead && !accept(front - window_.front)) break;
      if (can_behind && !accept(window_.back - back)) break;
      if (can_ahead) ++window_.ahead;
      if (can_behind) ++window_.behind;
      window_.front = front;
      window_.back = back;
    }
    return window_;
  }

 private:
  // Whether the path may go on by `chord`: it must have a direction, and turn no
  // more than allowed from every direction it had.
  bool accept(const Point& chord) {
    const double length = chord.norm();
    if (!(length > kRounding * interval_)) return false;
    const Point direction = chord / length;
    for (const Point& other : directions_) {
      if (direction.dot(other) < least_cosine_) return false;
    }
    directions_.push_back(direction);
    return true;
  }

  const Polyline<Dim>& polyline_;
  double start_;
  double interval_;
  double least_cosine_;
  int half_;
  Window<Dim> window_;
  std::vector<Point> directions_;
};

// Walks along the path from the vertex, forwards (step 1) or backwards (step -1),
// and collects where it first crosses the perpendiculars at 1, 2, ... `count`
// intervals. Points are relative to the vertex.
template <int Dim>
std::vector<typename Polyline<Dim>::Point> crossings(const Polyline<Dim>& polyline, int vertex,
                                                     int step, int count,
                                                     const typename Polyline<Dim>::Point& direction,
                                                     double interval,
                                                     const typename Polyline<Dim>::Point& end) {
  using Point = typename Polyline<Dim>::Point;
  const auto& points = polyline.points();
  std::vector<Point> found;
  found.reserve(count);
  Point near = Point::Zero();
  int next = vertex + step;
  for (int k = 1; k <= count; ++k) {
    const detail::Perpendicular<Dim> perpendicular(direction, k * interval);
    const auto can_walk = [&] { return next >= 0 && next < static_cast<int>(points.size()); };
    while (can_walk() && !perpendicular.is_reached_by(points[next] - points[vertex])) {
      near = points[next] - points[vertex];
      next += step;
    }
    found.push_back(can_walk() ? perpendicular.crossing(near, points[next] - points[vertex]) : end);
  }
  return found;
}

// Two unit vectors that make a right-handed basis with `direction`: in the plane,
// the left side.
Eigen::Matrix<double, 2, 1> side_axes(const Eigen::Vector2d& direction) {
  return {-direction.y(), direction.x()};
}

Eigen::Matrix<double, 3, 2> side_axes(const Eigen::Vector3d& direction) {
  Eigen::Vector3d::Index smallest = 0;
  direction.cwiseAbs().minCoeff(&smallest);
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = direction.cross(Eigen::Vector3d::Unit(smallest)).normalized();
  axes.col(1) = direction.cross(axes.col(0));
  return axes;
}

void turn_to_best_plane(Eigen::Matrix<double, 1, Eigen::Dynamic>&) {}

// Turns the offsets about the line so that the first row takes the most of them.
void turn_to_best_plane(Eigen::Matrix<double, 2, Eigen::Dynamic>& offsets) {
  const Eigen::Matrix2d scatter = offsets * offsets.transpose();
  double angle = 0.5 * std::atan2(2.0 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
  Eigen::Vector2d axis(std::cos(angle), std::sin(angle));
  if (axis.dot(offsets.rowwise().sum()) < 0.0) axis = -axis;
  Eigen::Matrix2d rotation;
  rotation << axis.x(), axis.y(), -axis.y(), axis.x();
  offsets = (rotation * offsets).eval();
}

double resolve_interval(double polyline_length, std::size_t points, double asked) {
  if (asked > 0.0) return asked;
  return points > 1 ? polyline_length / static_cast<double>(points - 1) : 0.0;
}

}  // namespace

void LapLineOptions::validate() const {
  require_fields_in_range(*this);
  if (window % 2 != 0) throw InvalidArgument("window", "must be even");
}

template <int Dim>
CurveDescriptor<Dim> lap_line(const Polyline<Dim>& polyline, int vertex,
                              const LapLineOptions& options) {
  options.validate();
  using Point = typename Polyline<Dim>::Point;
  const auto& points = polyline.points();
  if (vertex < 0 || static_cast<std::size_t>(vertex) >= points.size()) {
    throw InvalidArgument("vertex", std::to_string(vertex) + " is not one of the polyline's");
  }

  CurveDescriptor<Dim> descriptor;
  const double interval = resolve_interval(polyline.length(), points.size(), options.interval);
  descriptor.interval = interval;
  if (!(interval > 0.0)) return descriptor;
  const auto window = WindowGrower<Dim>(polyline, vertex, interval, options).grow();
  if (window.behind + window.ahead == 0) return descriptor;

  // No two directions in the window are more than a right angle apart, so the
  // chord is not zero, and either side of the window leads away from the vertex.
  descriptor.direction = (window.front - window.back).normalized();
  const Point& vertex_point = points[vertex];
  const auto samples_to = [&](const Point& end, const Point& outwards) {
    const double abscissa = (end - vertex_point).dot(outwards);
    return std::max(0, static_cast<int>(std::floor(abscissa / interval + kRounding)));
  };
  descriptor.ahead = samples_to(window.front, descriptor.direction);
  descriptor.behind = samples_to(window.back, -descriptor.direction);

  const auto before = crossings<Dim>(polyline, vertex, -1, descriptor.behind, -descriptor.direction,
                                     interval, window.back - vertex_point);
  const auto after = crossings<Dim>(polyline, vertex, 1, descriptor.ahead, descriptor.direction,
                                    interval, window.front - vertex_point);
  const auto axes = side_axes(descriptor.direction);
  descriptor.offsets.setZero(Dim - 1, descriptor.samples());
  for (int k = 0; k < descriptor.behind; ++k) {
    descriptor.offsets.col(descriptor.behind - 1 - k) = axes.transpose() * before[k];
  }
  for (int k = 0; k < descriptor.ahead; ++k) {
    descriptor.offsets.col(descriptor.behind + 1 + k) = axes.transpose() * after[k];
  }
  turn_to_best_plane(descriptor.offsets);
  return descriptor;
}

template <int Dim>
std::vector<CurveDescriptor<Dim>> lap_lines(const Polyline<Dim>& polyline,
                                            const std::vector<int>& vertices,
                                            const LapLineOptions& options, int threads,
                                            const ProgressCallback& progress) {
  std::vector<CurveDescriptor<Dim>> descriptors(vertices.size());
  parallel_for(static_cast<std::int64_t>(vertices.size()), threads, progress, "curve descriptors",
               [&](std::int64_t k) { descriptors[k] = lap_line(polyline, vertices[k], options); });
  return descriptors;
}

template CurveDescriptor<2> lap_line(const Polyline<2>&, int, const LapLineOptions&);
template CurveDescriptor<3> lap_line(const Polyline<3>&, int, const LapLineOptions&);
template std::vector<CurveDescriptor<2>> lap_lines(const Polyline<2>&, const std::vector<int>&,
                                                   const LapLineOptions&, int,
                                                   const ProgressCallback&);
template std::vector<CurveDescriptor<3>> lap_lines(const Polyline<3>&, const std::vector<int>&,
                                                   const LapLineOptions&, int,
                                                   const ProgressCallback&);

}  // namespace isotherm::geometry
