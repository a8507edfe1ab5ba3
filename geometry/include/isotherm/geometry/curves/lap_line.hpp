#pragma once

#include <concepts>
#include <numbers>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "isotherm/base/progress.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/geometry/curves/polyline.hpp"

namespace isotherm::geometry {

/// How the local shape of a curve is described (S. Datta et al., "SLAM Pose-graph
/// Robustification via Multi-scale Heat-Kernel Analysis", section V-A-1).
struct LapLineOptions {
  /// Metres between samples on the line, >= 0; 0: the polyline's mean segment
  /// length, the paper's L.
  double interval = 0.0;
  /// Arc length of the window in intervals, half to either side of the vertex;
  /// even, >= 2. The paper uses 30.
  int window = 30;
  /// Radians between any two directions of the path in the window, in
  /// (0, pi/2]. The paper uses pi/2.
  double max_turn = std::numbers::pi / 2.0;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, LapLineOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("interval", options.interval,
        "lap-line: metres between samples; 0: mean length of odometry edges", closed(0, 1e6));
  visit("window", options.window, "lap-line: arc length described, in intervals", closed(2, 10000));
  visit("max_turn", options.max_turn, "lap-line: radians the path may turn in the window",
        left_open(0, 1.5708));
}

/// Signed perpendicular offsets of a curve from a straight line through one of
/// its vertices, at equal intervals on that line.
template <int Dim>
struct CurveDescriptor {
  double interval = 0.0;  ///< metres between samples; 0 for a curve without length
  int behind = 0;         ///< samples before the vertex
  int ahead = 0;          ///< samples after the vertex
  /// Unit vector along the line, in the direction of travel; zero if the window
  /// holds nothing but the vertex.
  typename Polyline<Dim>::Point direction = Polyline<Dim>::Point::Zero();
  /// Metres, one column a sample (behind + 1 + ahead of them; the vertex's own is
  /// zero). In the plane the one row is positive to the left of the direction. In
  /// space the rows are the offset within the best-fitting plane that contains the
  /// line, positive towards the side where the path lies on the whole, and the
  /// offset out of it, along direction x in-plane axis.
  Eigen::Matrix<double, Dim - 1, Eigen::Dynamic> offsets =
      Eigen::Matrix<double, Dim - 1, Eigen::Dynamic>::Zero(Dim - 1, 1);

  int samples() const noexcept { return behind + 1 + ahead; }
};

/// Describes the polyline around one vertex as the paper does: a window grows both
/// ways, one interval of arc length a step, until it is full or the path turns too
/// much within it; the line runs through the vertex, parallel to the chord of the
/// window; offsets are taken where the path crosses the line's perpendiculars.
///
/// Only positions by arc length count, so that vertices inserted on the path
/// change nothing. Where the path crosses a perpendicular more than once, the
/// crossing first met from the vertex counts. At an end of the polyline the
/// window is one-sided; where nothing can be said (no length, or the path returns
/// to the vertex within an interval) the vertex is the only sample.
/// O(window^2 + points in the window + log n).
/// @throws InvalidArgument if `vertex` is not one of the polyline's, or for
///   options out of range.
template <int Dim>
CurveDescriptor<Dim> lap_line(const Polyline<Dim>& polyline, int vertex,
                              const LapLineOptions& options = {});

/// lap_line of several vertices, in their order, on `threads` threads (0: all
/// cores); the result does not depend on their number.
/// @throws InvalidArgument, Cancelled
template <int Dim>
std::vector<CurveDescriptor<Dim>> lap_lines(const Polyline<Dim>& polyline,
                                            const std::vector<int>& vertices,
                                            const LapLineOptions& options = {}, int threads = 0,
                                            const ProgressCallback& progress = {});

/// The descriptor of the same place when the curve is travelled the other way.
template <int Dim>
CurveDescriptor<Dim> reversed(const CurveDescriptor<Dim>& descriptor);

/// How unlike two descriptors are.
struct CurveDisparity {
  double rms = 0.0;  ///< metres, over the samples compared
  int samples = 1;   ///< samples compared; 1: only the vertices, which tells nothing
};

/// Compares two descriptors over the samples that both have. In space the smallest
/// value over rotations about the line is taken, so that it does not matter how
/// the plane was chosen. O(samples).
/// @throws InvalidArgument if the intervals differ.
template <int Dim>
CurveDisparity disparity(const CurveDescriptor<Dim>& a, const CurveDescriptor<Dim>& b);

}  // namespace isotherm::geometry
