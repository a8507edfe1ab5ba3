#include "isotherm/geometry/curves/curve_stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "isotherm/base/error.hpp"

namespace isotherm::geometry {
namespace {

template <int Dim>
double mean_gap(const CurveStretch<Dim>& a, int first, int count, const CurveStretch<Dim>& b,
                double cap, int least) {
  if (count < least) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  Eigen::ArrayXd squared(b.points.rows());
  for (int k = first; k < first + count; ++k) {
    squared = (b.points.col(0) - a.points(k, 0)).square();
    for (int d = 1; d < Dim; ++d) squared += (b.points.col(d) - a.points(k, d)).square();
    sum += std::min(cap, std::sqrt(squared.minCoeff()));
  }
  return sum / count;
}

}  // namespace

double StretchGap::least() const { return std::fmin(behind, ahead); }
double StretchGap::greatest() const { return std::fmax(behind, ahead); }

template <int Dim>
CurveStretch<Dim> stretch_around(const Polyline<Dim>& polyline, double arc_length, double window,
                                 double step) {
  if (!(step > 0.0 && step <= window && std::isfinite(window))) {
    throw InvalidArgument("step", "must be positive and at most the window");
  }
  const double reach = std::floor(window / step);
  CurveStretch<Dim> stretch;
  stretch.behind = static_cast<int>(std::clamp(std::floor(arc_length / step), 0.0, reach));
  stretch.ahead =
      static_cast<int>(std::clamp(std::floor((polyline.length() - arc_length) / step), 0.0, reach));
  stretch.points.resize(stretch.behind + 1 + stretch.ahead, Dim);
  for (int k = -stretch.behind; k <= stretch.ahead; ++k) {
    stretch.points.row(stretch.behind + k) = polyline.at(arc_length + k * step).transpose().array();
  }
  return stretch;
}

template <int Dim>
CurveStretch<Dim> cropped(const CurveStretch<Dim>& stretch, int behind, int ahead) {
  CurveStretch<Dim> result;
  result.behind = std::clamp(behind, 0, stretch.behind);
  result.ahead = std::clamp(ahead, 0, stretch.ahead);
  result.points =
      stretch.points.middleRows(stretch.behind - result.behind, result.behind + 1 + result.ahead);
  return result;
}

template <int Dim>
StretchGap stretch_gap(const CurveStretch<Dim>& a, const CurveStretch<Dim>& b, double cap,
                       int least) {
  if (!(cap > 0.0)) throw InvalidArgument("cap", "must be positive");
  if (least < 1) throw InvalidArgument("least", "must be positive");
  if (b.points.rows() == 0) throw InvalidArgument("b", "has no points");
  return {mean_gap(a, 0, a.behind, b, cap, least),
          mean_gap(a, a.behind + 1, a.ahead, b, cap, least)};
}

template CurveStretch<2> stretch_around(const Polyline<2>&, double, double, double);
template CurveStretch<3> stretch_around(const Polyline<3>&, double, double, double);
template CurveStretch<2> cropped(const CurveStretch<2>&, int, int);
template CurveStretch<3> cropped(const CurveStretch<3>&, int, int);
template StretchGap stretch_gap(const CurveStretch<2>&, const CurveStretch<2>&, double, int);
template StretchGap stretch_gap(const CurveStretch<3>&, const CurveStretch<3>&, double, int);

}  // namespace isotherm::geometry
