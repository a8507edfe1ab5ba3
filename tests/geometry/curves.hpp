#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "isotherm/geometry/curves/polyline.hpp"

namespace isotherm::geometry::curves {

template <int Dim>
using Curve = std::function<Eigen::Matrix<double, Dim, 1>(double)>;

/// The polyline through curve(t) for `count` + 1 equally spaced parameters.
template <int Dim>
Polyline<Dim> sample(const Curve<Dim>& curve, double first, double last, int count) {
  std::vector<Eigen::Matrix<double, Dim, 1>> points;
  for (int k = 0; k <= count; ++k) points.push_back(curve(first + (last - first) * k / count));
  return Polyline<Dim>(std::move(points));
}

/// The parameter in [low, high] at which an increasing function is `value`.
inline double solve(const std::function<double(double)>& increasing, double value, double low,
                    double high) {
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (increasing(middle) < value ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Integral by the composite Simpson rule.
inline double integrate(const std::function<double(double)>& f, double first, double last) {
  const int panels = 2000;
  const double h = (last - first) / (2 * panels);
  double sum = f(first) + f(last);
  for (int k = 1; k < 2 * panels; ++k) sum += (k % 2 == 1 ? 4.0 : 2.0) * f(first + k * h);
  return sum * h / 3.0;
}

}  // namespace isotherm::geometry::curves
