#pragma once

#include <vector>

#include <Eigen/Core>

namespace isotherm::geometry {

/// A piecewise-linear curve through points in the plane (Dim = 2) or in space
/// (Dim = 3), with its arc length at every vertex.
///
/// Only Dim 2 and 3 exist. Repeated points are allowed; they add no length.
template <int Dim>
class Polyline {
 public:
  using Point = Eigen::Matrix<double, Dim, 1>;

  Polyline() = default;

  /// O(n). @throws InvalidArgument if a coordinate is not finite.
  explicit Polyline(std::vector<Point> points);

  const std::vector<Point>& points() const noexcept { return points_; }

  /// Metres along the curve from the first point, one entry a point.
  const std::vector<double>& arc_lengths() const noexcept { return arc_lengths_; }

  /// Total length in metres; 0 for fewer than two points.
  double length() const noexcept { return arc_lengths_.empty() ? 0.0 : arc_lengths_.back(); }

  /// The point `arc_length` metres along the curve, or the end that is nearest to
  /// it. O(log n). @throws InvalidArgument if there are no points.
  Point at(double arc_length) const;

 private:
  std::vector<Point> points_;
  std::vector<double> arc_lengths_;
};

extern template class Polyline<2>;
extern template class Polyline<3>;

}  // namespace isotherm::geometry
