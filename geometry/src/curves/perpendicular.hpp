#pragma once

#include <cmath>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_2/Line_2_Segment_2.h>
#include <CGAL/Intersections_3/Plane_3_Segment_3.h>
#include <Eigen/Core>
#include <boost/variant/get.hpp>

namespace isotherm::geometry::detail {

/// The types of CGAL that stand for a perpendicular and what it meets.
template <int Dim>
struct CgalTypes;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

template <>
struct CgalTypes<2> {
  using Boundary = Kernel::Line_2;
  using Point = Kernel::Point_2;
  using Segment = Kernel::Segment_2;
  static Boundary boundary(const Eigen::Vector2d& normal, double offset) {
    return {normal.x(), normal.y(), offset};
  }
  static Point point(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }
  static Eigen::Vector2d vector(const Point& p) { return {p.x(), p.y()}; }
};

template <>
struct CgalTypes<3> {
  using Boundary = Kernel::Plane_3;
  using Point = Kernel::Point_3;
  using Segment = Kernel::Segment_3;
  static Boundary boundary(const Eigen::Vector3d& normal, double offset) {
    return {normal.x(), normal.y(), normal.z(), offset};
  }
  static Point point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
  static Eigen::Vector3d vector(const Point& p) { return {p.x(), p.y(), p.z()}; }
};

/// The line (in space, the plane) of the points whose component along `direction`
/// is `abscissa`. On which side of it a point lies is decided exactly.
template <int Dim>
class Perpendicular {
 public:
  using Cgal = CgalTypes<Dim>;
  using Point = Eigen::Matrix<double, Dim, 1>;

  Perpendicular(const Point& direction, double abscissa)
      : direction_(direction),
        abscissa_(abscissa),
        boundary_(Cgal::boundary(direction, -abscissa)) {}

  /// Whether `p` lies on the perpendicular or beyond it.
  bool is_reached_by(const Point& p) const {
    return boundary_.oriented_side(Cgal::point(p)) != CGAL::ON_NEGATIVE_SIDE;
  }

  /// Where the segment from `near`, which has not reached the perpendicular, to
  /// `far`, which has, crosses it.
  Point crossing(const Point& near, const Point& far) const {
    // Relative to `near`, so that short segments far from the origin lose nothing.
    const double missing = abscissa_ - direction_.dot(near);
    const typename Cgal::Segment segment(Cgal::point(Point::Zero()), Cgal::point(far - near));
    const auto met = CGAL::intersection(Cgal::boundary(direction_, -missing), segment);
    if (met) {
      if (const auto* p = boost::get<typename Cgal::Point>(&*met)) return near + Cgal::vector(*p);
    }
    // Rounding alone keeps the two apart: the nearer end stands for the crossing.
    return std::abs(missing) < std::abs(abscissa_ - direction_.dot(far)) ? near : far;
  }

 private:
  Point direction_;
  double abscissa_;
  typename Cgal::Boundary boundary_;
};

}  // namespace isotherm::geometry::detail
