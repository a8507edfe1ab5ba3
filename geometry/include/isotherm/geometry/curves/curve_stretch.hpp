#pragma once

#include <Eigen/Core>

#include "isotherm/geometry/curves/polyline.hpp"

namespace isotherm::geometry {

/// The part of a curve around a place on it, as points at equal steps of arc length.
template <int Dim>
struct CurveStretch {
  /// One row a point, in the order of travel; fewer than asked for at the ends of
  /// the curve.
  Eigen::Array<double, Eigen::Dynamic, Dim> points;
  int behind = 0;  ///< points before the place
  int ahead = 0;   ///< points after the place; the place itself is row `behind`
};

/// The stretch from `window` metres before to `window` metres after the place
/// `arc_length` metres along the polyline, a point every `step` metres.
/// O(window / step * log n).
/// @throws InvalidArgument unless 0 < step <= window, both finite, and the polyline
///   has points
template <int Dim>
CurveStretch<Dim> stretch_around(const Polyline<Dim>& polyline, double arc_length, double window,
                                 double step);

/// The stretch without its points beyond `behind` before and `ahead` after the place
/// (both >= 0; more than there are change nothing).
template <int Dim>
CurveStretch<Dim> cropped(const CurveStretch<Dim>& stretch, int behind, int ahead);

/// The mean distance, in metres, by which the halves of a stretch miss another curve.
struct StretchGap {
  double behind = 0.0;  ///< NaN if that half has fewer than `least` points
  double ahead = 0.0;   ///< likewise

  /// The smaller and the larger one of those that are known; NaN if neither is.
  double least() const;
  double greatest() const;
};

/// How far each half of `a` is from the points of `b`, both in one frame: the mean
/// over the half's points of the distance to the nearest point of `b`, no distance
/// counting more than `cap`. The order of points plays no part, so that curves
/// travelled in opposite senses match. O(rows of a * rows of b).
template <int Dim>
StretchGap stretch_gap(const CurveStretch<Dim>& a, const CurveStretch<Dim>& b, double cap,
                       int least);

}  // namespace isotherm::geometry
